"""One call for one picture."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any, Unpack, overload

import numpy.typing as npt

from ._arguments import Options
from ._explain import Explanation, Report
from ._mesh import Mesh, placed
from ._picture import Picture
from ._scene import Outputs, Scene


def scene_of(mesh: Any, triangles: npt.ArrayLike | None = None, poses: Sequence[Any] | None = None) -> Scene:
    """The scene of what users have: a scene as it is, else meshes before charcoal, in the studio's light."""
    if isinstance(mesh, Scene):
        return mesh
    if isinstance(mesh, (str, os.PathLike)) and os.fspath(mesh).lower().endswith(".json"):
        return Scene(mesh)
    if isinstance(mesh, Mesh) and triangles is None and poses is None:
        # A mesh keeps what was made of it to be drawn.
        if mesh._shown is None:
            scene = Scene()
            scene.add(mesh)
            mesh._shown = scene
        shown: Scene = mesh._shown
        return shown
    scene = Scene()
    for part in placed(mesh, triangles, poses):
        scene.add(part.mesh, pose=part.pose, **part.keys)
    return scene


@overload
def render(mesh: Any, triangles: npt.ArrayLike | None = ..., /, *, size: object = ..., camera: Any = ..., time: float = ...,
           floats: bool = ..., poses: Sequence[Any] | None = ..., outputs: None = ...,
           **options: Unpack[Options]) -> Picture: ...


@overload
def render(mesh: Any, triangles: npt.ArrayLike | None = ..., /, *, size: object = ..., camera: Any = ..., time: float = ...,
           floats: bool = ..., poses: Sequence[Any] | None = ..., outputs: Sequence[str],
           **options: Unpack[Options]) -> Outputs: ...


def render(mesh: Any, triangles: npt.ArrayLike | None = None, /, *, size: object = None, camera: Any = None,
           time: float = 0.0, floats: bool = False, poses: Sequence[Any] | None = None,
           outputs: Sequence[str] | None = None, **options: Unpack[Options]) -> Picture | Outputs:
    """Draws a picture of a mesh, an array of shape (height, width, 4) and type uint8.

    `mesh` and `triangles` are arrays of shape (n, 3), vertices and indices of vertices; or `mesh` alone is a path, a `Mesh`, a `Scene`, a mesh of trimesh,
    pyvista, Open3D or meshio, or a list of any of them, with `poses`, a matrix of 4 by 4 for each. What is not said is
    chosen so that the mesh is seen well: the camera, the lights, the normals, the background. The other arguments are
    those of `Scene.render`.
    """
    scene = scene_of(mesh, triangles, poses)
    return scene.render(size=size, camera=camera, time=time, floats=floats, outputs=outputs, **options)


def reference(mesh: Any, triangles: npt.ArrayLike | None = None, /, *, poses: Sequence[Any] | None = None,
              **arguments: Any) -> Any:
    """As `render`, by the reference renderer: every pixel in 64-bit arithmetic, slowly."""
    return scene_of(mesh, triangles, poses).reference(**arguments)


def sheet(mesh: Any, triangles: npt.ArrayLike | None = None, /, *, views: Sequence[str] | str = ("front", "right", "top", "iso"),
          size: object = (400, 300), poses: Sequence[Any] | None = None, **options: Unpack[Options]) -> Picture:
    """Several views of a mesh on one sheet with captions, each of `size` pixels."""
    return scene_of(mesh, triangles, poses).sheet(views, size=size, **options)


def turntable(mesh: Any, triangles: npt.ArrayLike | None = None, /, *, frames: int = 36, size: object = None,
              poses: Sequence[Any] | None = None, **options: Unpack[Options]) -> list[Picture]:
    """Pictures of a camera that turns once around a mesh."""
    return scene_of(mesh, triangles, poses).turntable(frames, size=size, **options)


def animate(mesh: Any, file: str | os.PathLike[str], *, frames: int | None = None, fps: int = 30, size: object = None,
            **options: Unpack[Options]) -> None:
    """Writes the animation of a scene, or a turn of the camera around a mesh, as an animated PNG."""
    scene_of(mesh).animate(file, frames, fps=fps, size=size, **options)


def explain(mesh: Any, at: Sequence[int], *, poses: Sequence[Any] | None = None, **arguments: Any) -> Explanation:
    """Explains the pixel in column and row `at` of a picture of a mesh or a scene: see `Scene.explain`."""
    return scene_of(mesh, None, poses).explain(at, **arguments)


def verify(picture: Any, scene: Any, **arguments: Any) -> dict[str, Any]:
    """Judges a picture of a scene by the reference renderer: see `Scene.verify`."""
    return scene_of(scene).verify(picture, **arguments)


def mark(picture: Any, scene: Any, **arguments: Any) -> Report:
    """Marks a picture that somebody has drawn of a scene: see `Scene.mark`."""
    return scene_of(scene).mark(picture, **arguments)
