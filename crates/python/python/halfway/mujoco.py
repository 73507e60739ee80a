"""MuJoCo's `Renderer`, drawn by halfway: no OpenGL, no display, no driver.

    import halfway.mujoco as mujoco

    model = mujoco.MjModel.from_xml_path("model.xml")
    with mujoco.Renderer(model, height=240, width=320) as renderer:
        renderer.update_scene(data, camera="track")
        pixels = renderer.render()

Methods, arguments and results are those of `mujoco.Renderer`; all other names are the package mujoco's own. MuJoCo itself says
which geoms are seen, where, and in which colours; halfway draws them by the equations of MuJoCo's classic renderer: Gouraud
shading, Blinn–Phong highlights, lights with ambient, diffuse and specular parts, cones and attenuation, colours that are not
encoded. Segments are MuJoCo's; off edges the colours of shapes of one colour are within a few steps of 255.

These are left out:

- shadows, reflections, haze, fog, and the outlines of what is selected;
- the skybox: the background has the mean of its colours; without one it is black;
- textures of type cube, which become the mean of their colours; textures of type 2d are drawn on planes, height fields and
  on meshes with texture coordinates;
- flexes, skins, lines and labels, and lights of type image;
- the far plane of perspective cameras: what lies beyond is drawn;
- the flags of `renderer.scene`.

Light above 1 at a corner or on a texture is held to 1 there by MuJoCo, by halfway in the picture: under strong lights its
textures are brighter. An orthographic camera sees highlights along its axis. Planes are lit at each pixel, MuJoCo's at the
corners of their grid, which of a plane without end are far apart. Where shapes meet at one depth, the one that is seen may be
another.
"""

from __future__ import annotations

import os
import tempfile
import warnings
from collections.abc import Callable
from typing import Any, TypeAlias

import mujoco
import numpy as np
import numpy.typing as npt

from ._mesh import Mesh
from ._parts import placed_by
from ._picture import Picture
from ._scene import Scene, SceneObject, SceneWarning

Array: TypeAlias = npt.NDArray[Any]
Shape: TypeAlias = tuple[Array, Array, Array, Array | None]
"""Vertices, triangles, normals and texture coordinates."""

PLANE, HFIELD, SPHERE, CAPSULE, ELLIPSOID, CYLINDER, BOX, MESH, SDF, ARROW, ARROW1, ARROW2, TRIANGLE, LABEL, NONE = (
    int(getattr(mujoco.mjtGeom, f"mjGEOM_{name}")) for name in
    ("PLANE", "HFIELD", "SPHERE", "CAPSULE", "ELLIPSOID", "CYLINDER", "BOX", "MESH", "SDF", "ARROW", "ARROW1", "ARROW2",
     "TRIANGLE", "LABEL", "NONE"))
TUBE, UPPER_CAP, LOWER_CAP = -1, -2, -3
"""The parts of a capsule of another length in each picture, as a tendon has it: parts are moved, where a shape would be made."""
SCALED = (SPHERE, ELLIPSOID, BOX, CYLINDER, TUBE, UPPER_CAP, LOWER_CAP)
OBJ_GEOM = int(mujoco.mjtObj.mjOBJ_GEOM)
ARROWS = (ARROW, ARROW1, ARROW2)
DRAWN = {PLANE, HFIELD, CAPSULE, MESH, SDF, TRIANGLE, *SCALED, *ARROWS}
FLOATS = 23
"""The numbers of a geom that lie one after the other: size 3, pos 3, mat 9, rgba 4, emission, specular, shininess, reflectance."""


def __getattr__(name: str) -> Any:
    """All other names are those of the package mujoco."""
    return getattr(mujoco, name)


def _rounds(radius: Array, z: Array, normal_radius: Array, normal_z: Array, slices: int) -> Shape:
    """A surface of revolution about z, by its outline from below to above."""
    angles = np.linspace(0, 2 * np.pi, slices + 1)
    around = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    rows = len(radius)
    vertices = np.empty((rows, slices + 1, 3))
    normals = np.empty_like(vertices)
    vertices[..., :2], vertices[..., 2] = radius[:, None, None] * around, z[:, None]
    normals[..., :2], normals[..., 2] = normal_radius[:, None, None] * around, normal_z[:, None]
    row, column = np.meshgrid(np.arange(rows - 1), np.arange(slices), indexing="ij")
    a = (row * (slices + 1) + column).reshape(-1)
    b, c, d = a + 1, a + slices + 2, a + slices + 1
    faces = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    flat = vertices.reshape(-1, 3)
    # Triangles at the poles have no area.
    area = np.linalg.norm(np.cross(flat[faces[:, 1]] - flat[faces[:, 0]], flat[faces[:, 2]] - flat[faces[:, 0]]), axis=1)
    return flat, faces[area > 1e-12], normals.reshape(-1, 3), None


def _joined(*parts: Shape) -> Shape:
    first = np.cumsum([0] + [len(part[0]) for part in parts])
    uvs = None if parts[0][3] is None else np.concatenate([part[3] for part in parts if part[3] is not None])
    return (np.concatenate([part[0] for part in parts]),
            np.concatenate([part[1] + start for part, start in zip(parts, first)]),
            np.concatenate([part[2] for part in parts]), uvs)


def _sphere(slices: int, stacks: int) -> Shape:
    elevation = np.linspace(-np.pi / 2, np.pi / 2, stacks + 1)
    r, z = np.cos(elevation), np.sin(elevation)
    return _rounds(r, z, r, z, slices)


def _disc(z: float, radius: float, slices: int, stacks: int) -> Shape:
    r = np.linspace(radius, 0, stacks + 1) if z > 0 else np.linspace(0, radius, stacks + 1)
    return _rounds(r, np.full(stacks + 1, z), np.zeros(stacks + 1), np.full(stacks + 1, np.sign(z)), slices)


def _side(radius: float, half: float, slices: int, stacks: int) -> Shape:
    z = np.linspace(-half, half, stacks + 1)
    return _rounds(np.full(stacks + 1, radius), z, np.ones(stacks + 1), np.zeros(stacks + 1), slices)


def _cylinder(slices: int, stacks: int) -> Shape:
    return _joined(_side(1, 1, slices, stacks), _disc(1, 1, slices, stacks), _disc(-1, 1, slices, stacks))


def _cap(side: int, slices: int, stacks: int) -> Shape:
    """Half of a sphere, above or below."""
    elevation = np.linspace(0, np.pi / 2, max(stacks // 2, 1) + 1)
    r, z = np.cos(elevation), np.sin(elevation)
    return _rounds(r, z, r, z, slices) if side > 0 else _rounds(r[::-1], -z[::-1], r[::-1], -z[::-1], slices)


def _capsule(radius: float, half: float, slices: int, stacks: int) -> Shape:
    above, below = _cap(1, slices, stacks), _cap(-1, slices, stacks)
    return _joined((below[0] * radius - [0, 0, half], *below[1:]), _side(radius, half, slices, stacks),
                   (above[0] * radius + [0, 0, half], *above[1:]))


def _arrow(radius: float, size: float, kind: int, slices: int, stacks: int) -> Shape:
    """An arrow along z from 0 to half of its size; of the kind ARROW1 the head is no wider than the shaft, of the kind ARROW2
    there is another half below."""
    length, wide = size / 2, radius if kind == ARROW1 else 1.75 * radius
    tip = 0.32 * length
    slope = np.array([wide, tip]) / np.hypot(wide, tip)
    ones = np.ones(stacks + 1)
    cone = _rounds(np.linspace(wide, 0, stacks + 1), np.linspace(length - tip, length, stacks + 1), slope[1] * ones,
                   slope[0] * ones, slices)
    under, bottom = _disc(-1, wide, slices, 1), _disc(-1, radius, slices, 1)
    shaft = _side(radius, (length - tip) / 2, slices, stacks)
    parts = [(shaft[0] + [0, 0, (length - tip) / 2], *shaft[1:]), cone, (under[0] + [0, 0, 1 + length - tip], *under[1:])]
    if kind == ARROW2:
        flip = np.array([1.0, -1.0, -1.0])
        parts += [(part[0] * flip, part[1], part[2] * flip, None) for part in parts]
    else:
        parts.append((bottom[0] + [0, 0, 1], *bottom[1:]))
    return _joined(*parts)


def _grid(xs: Array, ys: Array) -> tuple[Array, Array]:
    x, y = np.meshgrid(xs, ys)
    vertices = np.stack([x, y, np.zeros_like(x)], axis=2).reshape(-1, 3)
    row, column = np.meshgrid(np.arange(len(ys) - 1), np.arange(len(xs) - 1), indexing="ij")
    a = (row * len(xs) + column).reshape(-1)
    b, c, d = a + 1, a + len(xs) + 1, a + len(xs)
    return vertices, np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])


def _box(quads: int) -> Shape:
    line = np.linspace(-1, 1, quads + 1)
    flat, faces = _grid(line, line)
    x, y = flat[:, 0], flat[:, 1]
    sides = []
    for axis in range(3):
        for sign in (1.0, -1.0):
            vertices = np.empty((len(flat), 3))
            vertices[:, axis], vertices[:, (axis + 1) % 3], vertices[:, (axis + 2) % 3] = sign, x, sign * y
            normals = np.zeros_like(vertices)
            normals[:, axis] = sign
            sides.append((vertices, faces, normals, None))
    return _joined(*sides)


def _plane(half: tuple[float, float]) -> Shape:
    vertices, faces = _grid(np.array([-half[0], half[0]]), np.array([-half[1], half[1]]))
    return vertices, faces, np.tile([0.0, 0.0, 1.0], (4, 1)), None


def _height_field(model: Any, number: int) -> Shape:
    """The surface, its sides and its floor."""
    rows, columns, start = int(model.hfield_nrow[number]), int(model.hfield_ncol[number]), int(model.hfield_adr[number])
    x, y, top, base = (float(v) for v in model.hfield_size[number])
    heights = np.asarray(model.hfield_data[start:start + rows * columns], float).reshape(rows, columns) * top
    vertices, faces = _grid(np.linspace(-x, x, columns), np.linspace(-y, y, rows))
    vertices[:, 2] = heights.reshape(-1)
    dy, dx = np.gradient(heights, 2 * y / (rows - 1), 2 * x / (columns - 1))
    normals = np.stack([-dx, -dy, np.ones_like(dx)], axis=2).reshape(-1, 3)
    parts: list[Shape] = [(vertices, faces, normals / np.linalg.norm(normals, axis=1, keepdims=True), None)]
    grid = vertices.reshape(rows, columns, 3)
    for edge, normal in ((grid[0], (0, -1, 0)), (grid[-1, ::-1], (0, 1, 0)), (grid[::-1, 0], (-1, 0, 0)),
                         (grid[:, -1], (1, 0, 0))):
        n = len(edge)
        floor = edge.copy()
        floor[:, 2] = -base
        a = np.arange(n - 1)
        wall = np.concatenate([np.stack([a, a + 1, a + n + 1], 1), np.stack([a, a + n + 1, a + n], 1)])
        parts.append((np.concatenate([floor, edge]), wall, np.tile(np.array(normal, float), (2 * n, 1)), None))
    corners = np.array([[-x, -y, -base], [-x, y, -base], [x, y, -base], [x, -y, -base]])
    parts.append((corners, np.array([[0, 1, 2], [0, 2, 3]]), np.tile([0.0, 0.0, -1.0], (4, 1)), None))
    return _joined(*parts)


def _mesh(model: Any, number: int) -> Shape:
    """A mesh of the model, with corners of its own where normals or texture coordinates need them."""
    first, count = int(model.mesh_vertadr[number]), int(model.mesh_vertnum[number])
    start, faces = int(model.mesh_faceadr[number]), int(model.mesh_facenum[number])
    vertices = np.asarray(model.mesh_vert[first:first + count], float)
    corners = np.asarray(model.mesh_face[start:start + faces]).reshape(-1)
    normal, normals = int(model.mesh_normaladr[number]), int(model.mesh_normalnum[number])
    of_normal = np.asarray(model.mesh_facenormal[start:start + faces]).reshape(-1)
    all_normals = np.asarray(model.mesh_normal[normal:normal + normals], float)
    uvs = None
    if (coordinates := int(model.mesh_texcoordadr[number])) >= 0:
        of_uv = np.asarray(model.mesh_facetexcoord[start:start + faces]).reshape(-1)
        uvs = np.asarray(model.mesh_texcoord[coordinates:coordinates + int(model.mesh_texcoordnum[number])], float)[of_uv]
    placed, chosen = vertices[corners], all_normals[of_normal]
    of_face = np.repeat(_face_normals(placed), 3, axis=0)
    # As in MuJoCo, a corner whose normal is far from that of its face has the face's.
    is_far = (chosen * of_face).sum(axis=1) < 0.8
    chosen[is_far] = of_face[is_far]
    return placed, np.arange(len(corners)).reshape(-1, 3), chosen, uvs


def _face_normals(placed: Array) -> Array:
    corners = placed.reshape(-1, 3, 3)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return np.asarray(normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30))


def _hull(model: Any, number: int) -> Shape:
    """The convex hull of a mesh, with normals of its faces."""
    first, count = int(model.mesh_vertadr[number]), int(model.mesh_vertnum[number])
    vertices = np.asarray(model.mesh_vert[first:first + count], float)
    start = int(model.mesh_graphadr[number])
    if start < 0:
        return _mesh(model, number)
    graph = np.asarray(model.mesh_graph[start:])
    corners_of, faces_of = int(graph[0]), int(graph[1])
    begin = 2 + 3 * corners_of + 3 * faces_of
    faces = graph[begin:begin + 3 * faces_of].reshape(-1, 3)
    placed = vertices[faces.reshape(-1)]
    return placed, np.arange(len(placed)).reshape(-1, 3), np.repeat(_face_normals(placed), 3, axis=0), None


def _texture(model: Any, number: int) -> Array:
    """A texture as an array of bytes, its first row first."""
    width, height = int(model.tex_width[number]), int(model.tex_height[number])
    channels = int(model.tex_nchannel[number]) if hasattr(model, "tex_nchannel") else 3
    data = model.tex_data if hasattr(model, "tex_data") else model.tex_rgb
    start = int(model.tex_adr[number])
    return np.asarray(data[start:start + width * height * channels], np.uint8).reshape(height, width, channels)


def _encoded(image: Array) -> Array:
    """Numbers that halfway decodes from sRGB to those given, which are not encoded."""
    linear = image / 255.0
    encoded = np.where(linear <= 0.0031308, linear * 12.92, 1.055 * linear ** (1 / 2.4) - 0.055)
    return np.asarray(np.round(encoded * 255).astype(np.uint8))


class Renderer:
    """Draws the scenes of a model. `max_geom` is the largest number of geoms; `font_scale` has no effect."""

    def __init__(self, model: Any, height: int = 240, width: int = 320, max_geom: int = 10000, font_scale: Any = None) -> None:
        if not (1 <= height <= 16384 and 1 <= width <= 16384):
            raise ValueError(f"height: {height}, width: {width}; expected 1 to 16384 pixels each")
        self._model, self._height, self._width = model, int(height), int(width)
        self._visible = mujoco.MjvScene(model=model, maxgeom=max_geom)
        self._scene_option = mujoco.MjvOption()
        self._meshes: dict[Any, Mesh] = {}
        self._folder: tempfile.TemporaryDirectory[str] | None = None
        self._images: dict[int, str] = {}
        self._warned: set[str] = set()
        self._numbers: Callable[[int], Array] | None = None
        self._scene: Scene | None = None
        self._drawn: list[int] = []
        self._recipe: Any = None
        self._poses: Array = np.zeros((0, 4, 4), np.float32)
        self._objects: list[SceneObject] = []
        self._geoms: list[Any] = []
        self._camera: dict[str, Any] | None = None
        self._camera_numbers: list[Any] = []
        self._light_numbers: list[Any] | None = None
        self._lights: list[dict[str, Any]] = []
        self._mode = "color"
        self._is_closed = False

    @property
    def model(self) -> Any:
        """The model that is drawn."""
        return self._model

    @property
    def scene(self) -> Any:
        """MuJoCo's abstract scene. Geoms may be added to it between `update_scene` and `render`."""
        return self._visible

    @property
    def height(self) -> int:
        """The height of pictures, in pixels."""
        return self._height

    @property
    def width(self) -> int:
        """The width of pictures, in pixels."""
        return self._width

    def enable_depth_rendering(self) -> None:
        """From now on `render` gives distances along the axis of the camera."""
        self._mode = "depth"

    def disable_depth_rendering(self) -> None:
        """From now on `render` gives colours."""
        if self._mode == "depth":
            self._mode = "color"

    def enable_segmentation_rendering(self) -> None:
        """From now on `render` gives the objects that are seen."""
        self._mode = "segmentation"

    def disable_segmentation_rendering(self) -> None:
        """From now on `render` gives colours."""
        if self._mode == "segmentation":
            self._mode = "color"

    def update_scene(self, data: Any, camera: Any = -1, scene_option: Any = None) -> None:
        """Takes the state of `data`, seen by a camera of the model (its name or number), by the free camera (-1), or by a
        `mujoco.MjvCamera`."""
        if not isinstance(camera, mujoco.MjvCamera):
            number = camera
            if isinstance(number, str):
                number = mujoco.mj_name2id(self._model, mujoco.mjtObj.mjOBJ_CAMERA.value, number)
                if number == -1:
                    raise ValueError(f'The camera "{camera}" does not exist.')
            if not -1 <= number < self._model.ncam:
                raise ValueError(f"The camera id {number} is out of range [-1, {self._model.ncam}).")
            camera = mujoco.MjvCamera()
            camera.fixedcamid = number
            if number == -1:
                camera.type = mujoco.mjtCamera.mjCAMERA_FREE
                mujoco.mjv_defaultFreeCamera(self._model, camera)
            else:
                camera.type = mujoco.mjtCamera.mjCAMERA_FIXED
        option = scene_option if scene_option is not None else self._scene_option
        mujoco.mjv_updateScene(self._model, data, option, None, camera, mujoco.mjtCatBit.mjCAT_ALL.value, self._visible)

    def render(self, *, out: Array | None = None) -> Array:
        """Draws the scene: (height, width, 3) of uint8; as depth (height, width) of float32, the far plane's where nothing
        is; as segmentation (height, width, 2) of int32, the number and the type of the object, -1 where nothing is. With
        `out` the result is put there."""
        if self._is_closed:
            raise RuntimeError("render cannot be called after close.")
        shape = (self._height, self._width) + {"color": (3,), "depth": (), "segmentation": (2,)}[self._mode]
        if out is not None and out.shape != shape:
            raise ValueError(f"Expected `out.shape == {shape}`. Got `out.shape={out.shape}` instead.")
        scene = self._updated()
        size = (self._width, self._height)
        with warnings.catch_warnings():
            # A picture of nothing is one that MuJoCo gives without a word.
            warnings.filterwarnings("ignore", "the picture shows nothing", SceneWarning)
            if self._mode == "color":
                found = np.ascontiguousarray(scene.render(size=size)[..., :3])
            elif self._mode == "depth":
                depth = scene.render(size=size, outputs=["depth"], samples=1)["depth"]
                far = np.float32(self._model.vis.map.zfar * self._model.stat.extent)
                found = np.where(depth > 0, np.minimum(depth, far), far).astype(np.float32)
            else:
                table = np.full((len(self._drawn) + 1, 2), -1, np.int32)
                for number, index in enumerate(self._drawn):
                    geom = self._geom(index)
                    if geom.segid != -1:
                        table[number + 1] = geom.objid, geom.objtype
                found = table[np.asarray(scene.render(size=size, outputs=["id"], samples=1)["id"])]
        if out is None:
            return found
        np.copyto(out, found, casting="unsafe")
        return out

    def close(self) -> None:
        """Frees what is kept. Afterwards `render` is an error."""
        self._is_closed = True
        self._scene, self._recipe = None, None
        self._meshes.clear()
        if self._folder is not None:
            self._folder.cleanup()
            self._folder = None

    def __enter__(self) -> Renderer:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __del__(self) -> None:
        # Where a check of the arguments has failed, there is nothing to close.
        if hasattr(self, "_is_closed"):
            self.close()

    # From MuJoCo's scene to halfway's.

    def _warn(self, sentence: str) -> None:
        if sentence not in self._warned:
            self._warned.add(sentence)
            warnings.warn(sentence, SceneWarning, stacklevel=5)

    def _floats(self, count: int) -> Array:
        """The numbers of the first geoms, a row each: read as one array where they lie as this file expects, as the
        attributes of each are slow."""
        if self._numbers is None and count >= 2:
            self._numbers = _as_one_array(self._visible)
        if self._numbers is None:
            return _one_by_one(self._visible, count)
        return self._numbers(count)

    def _updated(self) -> Scene:
        visible = self._visible
        count = int(visible.ngeom)
        floats = self._floats(count)
        drawn, keys, scaled = [], [], []
        for index in range(count):
            geom = self._geom(index)
            kind = geom.type
            if kind not in DRAWN:
                if kind not in (LABEL, NONE):
                    self._warn(f"{mujoco.mjtGeom(kind).name} is not drawn by halfway.mujoco")
                continue
            if kind in (MESH, SDF) and geom.dataid < 0:
                self._warn("a geom without its mesh is not drawn by halfway.mujoco")
                continue
            parts = (TUBE, UPPER_CAP, LOWER_CAP) if kind == CAPSULE and geom.objtype != OBJ_GEOM else (kind,)
            for part in parts:
                drawn.append(index)
                keys.append((part, geom.dataid, geom.matid))
                scaled.append(part in SCALED)
        rows = floats if len(drawn) == count else floats[drawn]
        camera, lights = self._seen_from(), self._lit_by()
        # All that the drawing is made for; the rest is moved.
        is_scaled = np.array(scaled, bool)
        sizes = np.where(is_scaled[:, None], 1, rows[:, :3])
        recipe = (keys, sizes.tobytes(), rows[:, 15:].tobytes(), len(lights), [light["kind"] for light in lights],
                  camera.keys())
        poses = np.zeros((len(drawn), 4, 4), np.float32)
        poses[:, :3, :3] = rows[:, 6:15].reshape(-1, 3, 3)
        poses[:, :3, 3], poses[:, 3, 3] = rows[:, 3:6], 1
        if len(drawn) != len(set(drawn)):
            rows = rows.copy()
            for number, (part, _, _) in enumerate(keys):
                if part in (UPPER_CAP, LOWER_CAP):
                    end = rows[number, 2] if part == UPPER_CAP else -rows[number, 2]
                    poses[number, :3, 3] += end * poses[number, :3, 2]
                    rows[number, 2] = rows[number, 0]
        poses[is_scaled, :3, :3] *= np.maximum(rows[is_scaled, None, :3], 1e-12)
        self._drawn = drawn
        if self._scene is None or recipe != self._recipe:
            self._scene = self._made(drawn, [key[0] for key in keys], rows, poses, camera, lights)
            self._objects = self._scene.objects
        else:
            moved = np.flatnonzero((self._poses != poses).any(axis=(1, 2)))
            if len(moved):
                self._scene.place([self._objects[i] for i in moved], poses[moved])
            if camera is not self._camera and camera != self._camera:
                self._scene.camera.set(**camera)
            if lights is not self._lights:
                for light, old, new in zip(self._scene.lights, self._lights, lights):
                    if old != new:
                        light.set(**new)
        self._recipe, self._poses, self._camera, self._lights = recipe, poses, camera, lights
        return self._scene

    def _made(self, drawn: list[int], kinds: list[int], rows: Array, poses: Array, camera: dict[str, Any],
              lights: list[dict[str, Any]]) -> Scene:
        scene = Scene({
            "output": "raw", "background": self._background(), "ambient": [0, 0, 0], "shading": "gouraud",
            "viewer": "local", "samples": 4 if self._model.vis.quality.offsamples >= 4 else 1,
            "camera": camera, "lights": lights, "objects": [],
        })
        for index, kind, row, pose in zip(drawn, kinds, rows, poses):
            geom = self._geom(index)
            texture = self._texture_of(geom)
            scene.add(self._mesh_of(geom, kind, row[:3], texture), pose=pose, **self._object_keys(geom, row, texture))
        return scene

    def _background(self) -> list[float]:
        for number in range(self._model.ntex):
            if self._model.tex_type[number] == mujoco.mjtTexture.mjTEXTURE_SKYBOX:
                self._warn("the skybox is not drawn by halfway.mujoco; the background has the mean of its colours")
                mean = _texture(self._model, number).reshape(-1, _texture(self._model, number).shape[2]).mean(axis=0)
                return [float(value) / 255 for value in mean[:3]]
        return [0.0, 0.0, 0.0]

    def _texture_of(self, geom: Any) -> int:
        """The texture of a geom, -1 for none."""
        if hasattr(geom, "texid"):
            return int(geom.texid)
        if geom.matid < 0:
            return -1
        of_material = np.asarray(self._model.mat_texid[geom.matid]).reshape(-1)
        return int(of_material[mujoco.mjtTextureRole.mjTEXROLE_RGB] if len(of_material) > 1 else of_material[0])

    def _mesh_of(self, geom: Any, kind: int, size: Array, texture: int) -> Mesh:
        model, quality = self._model, self._model.vis.quality
        slices, stacks, quads = (max(int(n), 2) for n in (quality.numslices, quality.numstacks, quality.numquads))
        slices = max(slices, 3)
        own_size = () if kind in SCALED else tuple(float(v) for v in size)
        key = (kind, int(geom.dataid), own_size, texture, int(geom.matid))
        if key in self._meshes:
            return self._meshes[key]
        if len(self._meshes) >= 512:
            # Arrows have another length in each picture.
            self._meshes.clear()
        if kind in (SPHERE, ELLIPSOID):
            shape = _sphere(slices, stacks)
        elif kind == BOX:
            shape = _box(quads)
        elif kind == CYLINDER:
            shape = _cylinder(slices, stacks)
        elif kind == CAPSULE:
            shape = _capsule(own_size[0], own_size[2], slices, stacks)
        elif kind in ARROWS:
            shape = _arrow(own_size[0], own_size[2], kind, slices, stacks)
        elif kind == TRIANGLE:
            corners = np.array([[0, 0, 0], [own_size[0], 0, 0], [0, own_size[1], 0]], float)
            shape = corners, np.array([[0, 1, 2]]), np.tile([0.0, 0.0, 1.0], (3, 1)), None
        elif kind == PLANE:
            far = float(model.vis.map.zfar * model.stat.extent)
            shape = _plane((own_size[0] or far, own_size[1] or far))
        elif kind == HFIELD:
            shape = _height_field(model, int(geom.dataid))
        elif kind == TUBE:
            shape = _side(1, 1, slices, stacks)
        elif kind in (UPPER_CAP, LOWER_CAP):
            shape = _cap(1 if kind == UPPER_CAP else -1, slices, stacks)
        else:
            shape = (_hull if geom.dataid % 2 else _mesh)(model, int(geom.dataid) // 2)
        vertices, faces, normals, uvs = shape
        if uvs is None and texture >= 0 and kind in (PLANE, HFIELD):
            uvs = self._plane_uvs(geom, vertices, own_size)
        self._meshes[key] = Mesh(vertices, faces, normals=normals, uvs=None if uvs is None else uvs * [1, -1] + [0, 1])
        return self._meshes[key]

    def _repeat(self, geom: Any) -> tuple[Array, bool]:
        if hasattr(geom, "texrepeat"):
            return np.asarray(geom.texrepeat, float), bool(geom.texuniform)
        return np.asarray(self._model.mat_texrepeat[geom.matid], float), bool(self._model.mat_texuniform[geom.matid])

    def _plane_uvs(self, geom: Any, vertices: Array, size: tuple[float, ...]) -> Array:
        """Texture coordinates across a plane: so many repetitions over it, or, where it is uniform or has no end, a unit."""
        repeat, is_uniform = self._repeat(geom)
        if int(geom.type) == HFIELD:
            size = tuple(float(v) for v in self._model.hfield_size[int(geom.dataid)])
        scale = np.array([r if is_uniform or not s else r / s for r, s in zip(repeat, size)])
        is_whole = int(geom.type) == PLANE and min(size[:2]) > 0
        return np.asarray(vertices[:, :2] * scale * [0.5, -0.5] + (scale * size[:2] / 2 if is_whole else -0.5))

    def _object_keys(self, geom: Any, row: Array, texture: int) -> dict[str, Any]:
        rgba = np.clip(row[15:19].astype(float), 0, 1)
        emission, specular, shininess = (float(v) for v in row[19:22])
        color = rgba[:3]
        keys: dict[str, Any] = {"normals": "keep"}
        kind = int(geom.type)
        if texture >= 0 and self._model.tex_type[texture] == mujoco.mjtTexture.mjTEXTURE_2D and (
                geom.texcoord or kind in (PLANE, HFIELD)):
            image = {"path": self._image(texture)}
            keys["maps"] = {"color": image, "specular": image, "emission": image}
        elif texture >= 0:
            pixels = _texture(self._model, texture)
            color = color * pixels.reshape(-1, pixels.shape[2])[:, :3].mean(axis=0) / 255
        keys["material"] = {
            "ambient": color.tolist(), "diffuse": color.tolist(), "specular": [specular] * 3,
            "emission": (color * emission).tolist(), "shininess": 128 * shininess, "opacity": float(rgba[3]),
        }
        if rgba[3] < 1:
            # MuJoCo blends the front of what is transparent twice.
            keys["material"]["opacity"] = 1 - (1 - float(rgba[3])) ** 2
            keys["blend"] = True
        if kind == PLANE:
            keys["shading"] = "phong"
        if kind in (PLANE, TRIANGLE):
            keys["faces"] = "both"
        return keys

    def _image(self, texture: int) -> str:
        """The file of a texture."""
        if texture not in self._images:
            if self._folder is None:
                self._folder = tempfile.TemporaryDirectory(prefix="halfway-mujoco-")
            path = os.path.join(self._folder.name, f"{texture}.png")
            pixels = _encoded(_texture(self._model, texture)[..., :3])
            Picture(pixels if pixels.shape[2] == 3 else np.repeat(pixels, 3, axis=2)).save(path)
            self._images[texture] = path
        return self._images[texture]

    def _geom(self, index: int) -> Any:
        while len(self._geoms) <= index:
            self._geoms.append(self._visible.geoms[len(self._geoms)])
        return self._geoms[index]

    def _seen_from(self) -> dict[str, Any]:
        """The keys of the camera, worked out anew where it has changed."""
        numbers = []
        for camera in (self._visible.camera[0], self._visible.camera[1]):
            numbers += [camera.pos.tobytes(), camera.forward.tobytes(), camera.up.tobytes(), camera.frustum_center,
                        camera.frustum_bottom, camera.frustum_top, camera.frustum_near, camera.frustum_far,
                        camera.orthographic]
        if self._camera is None or numbers != self._camera_numbers:
            self._camera_numbers = numbers
            return self._camera_keys()
        return self._camera

    def _lit_by(self) -> list[dict[str, Any]]:
        """The keys of the lights, worked out anew where one has changed."""
        numbers: list[Any] = []
        for light in self._visible.lights[:self._visible.nlight]:
            # The headlight moves with the camera.
            place = None if light.headlight else (light.pos.tobytes(), light.dir.tobytes())
            numbers += [place, light.ambient.tobytes(), light.diffuse.tobytes(), light.specular.tobytes(),
                        light.attenuation.tobytes(), light.type, light.cutoff, light.exponent]
        if numbers != self._light_numbers:
            self._light_numbers = numbers
            return self._light_keys()
        return self._lights

    def _camera_keys(self) -> dict[str, Any]:
        left, right = self._visible.camera[0], self._visible.camera[1]
        position = (np.asarray(left.pos, float) + right.pos) / 2
        forward, up = np.asarray(left.forward, float), np.asarray(left.up, float)
        pose = np.eye(4)
        pose[:3, 0], pose[:3, 1], pose[:3, 2], pose[:3, 3] = np.cross(forward, up), up, -forward, position
        bottom, top, near = float(left.frustum_bottom), float(left.frustum_top), float(left.frustum_near)
        center = (float(left.frustum_center) + float(right.frustum_center)) / 2
        height, width = self._height, self._width
        keys = placed_by(pose)
        if left.orthographic:
            middle = [center / (top - bottom), (top + bottom) / 2 / (top - bottom)]
            return keys | {"height": top - bottom, "near": near, "far": float(left.frustum_far), "shift": middle}
        # Pixels are square.
        focal = near * height / (top - bottom)
        middle = [width / 2 - center * focal / near, height * top / (top - bottom)]
        return keys | {"near": near, "intrinsics": {"focal": [focal, focal], "center": middle, "size": [width, height]}}

    def _light_keys(self) -> list[dict[str, Any]]:
        found = []
        for number in range(int(self._visible.nlight)):
            light = self._visible.lights[number]
            kind = int(light.type)
            keys: dict[str, Any] = {name: np.asarray(getattr(light, name), float).tolist()
                                    for name in ("ambient", "diffuse", "specular")}
            if kind == mujoco.mjtLightType.mjLIGHT_DIRECTIONAL:
                keys["kind"] = "directional"
                if light.headlight:
                    keys |= {"attach": "camera", "direction": [0.0, 0.0, -1.0]}
                else:
                    keys["direction"] = np.asarray(light.dir, float).tolist()
            elif kind in (mujoco.mjtLightType.mjLIGHT_SPOT, mujoco.mjtLightType.mjLIGHT_POINT):
                keys |= {"kind": "point", "position": np.asarray(light.pos, float).tolist(), "attenuate_ambient": True,
                         "attenuation": np.asarray(light.attenuation, float).tolist()}
                if kind == mujoco.mjtLightType.mjLIGHT_SPOT:
                    keys |= {"kind": "spot", "direction": np.asarray(light.dir, float).tolist(),
                             "cutoff_deg": _cutoff(float(light.cutoff)), "exponent": float(light.exponent)}
            else:
                self._warn("lights of type image are not drawn by halfway.mujoco")
                continue
            found.append(keys)
        return found


def _cutoff(degrees: float) -> float:
    return degrees if degrees <= 90 else 180.0


def _one_by_one(visible: Any, count: int) -> Array:
    rows = np.empty((count, FLOATS), np.float32)
    for index in range(count):
        geom = visible.geoms[index]
        rows[index, :3], rows[index, 3:6], rows[index, 6:15] = geom.size, geom.pos, np.asarray(geom.mat).reshape(-1)
        rows[index, 15:19] = geom.rgba
        rows[index, 19:] = geom.emission, geom.specular, geom.shininess, geom.reflectance
    return rows


def _as_one_array(visible: Any) -> Callable[[int], Array] | None:
    """Reads the numbers of geoms where they lie in memory, if they lie as they are expected to."""
    first, second = visible.geoms[0].size, visible.geoms[1].size
    stride = second.__array_interface__["data"][0] - first.__array_interface__["data"][0]
    if first.dtype != np.float32 or stride < 4 * FLOATS:
        return None

    def read(count: int) -> Array:
        return np.array(np.lib.stride_tricks.as_strided(first, (count, FLOATS), (stride, 4)))

    return read if np.array_equal(read(2), _one_by_one(visible, 2)) else None
