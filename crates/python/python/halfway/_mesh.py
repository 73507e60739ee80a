"""Meshes from arrays, from files and from other packages."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from . import _halfway
from ._arguments import Floats, Indices, counted, floats, matrix, triangles
from ._picture import Picture


class Mesh:
    """Triangles that do not change, to be drawn any number of times.

    `vertices` has the shape (n, 3). `faces` has (m, 3), indices of vertices, counter-clockwise seen from the front; or
    (m, 4) for quadrilaterals. Of each vertex there may be `normals` (n, 3), `uvs` (n, 2), with (0, 0) at the lower left
    of an image, and `colors` (n, 3) or (n, 4): of type uint8 in sRGB, else linear, 0 to 1. `face_colors` are one a face.
    `image` is an array as pictures have it, whose colours cover the mesh by its `uvs`. `properties` are numbers with a
    name, one a vertex or one a face, which the option `scalars` shows.
    """

    __slots__ = ("_mesh", "_shown")

    def __init__(
        self,
        vertices: npt.ArrayLike,
        faces: npt.ArrayLike,
        *,
        normals: npt.ArrayLike | None = None,
        uvs: npt.ArrayLike | None = None,
        colors: npt.ArrayLike | None = None,
        face_colors: npt.ArrayLike | None = None,
        image: npt.ArrayLike | None = None,
        properties: Mapping[str, npt.ArrayLike] | None = None,
        name: str = "mesh",
    ) -> None:
        positions, origin = counted(vertices, "vertices")
        indices, of_face = triangles(faces, len(positions))
        given_faces = len(indices) if of_face is None else len(indices) // 2
        per_vertex = {
            "normals": None if normals is None else floats(normals, "normals", 3),
            "uvs": None if uvs is None else floats(uvs, "uvs", 2) * (1, -1) + (0, 1),
            "colors": None if colors is None else linear_colors(colors, "colors"),
        }
        for key, values in per_vertex.items():
            if values is not None and len(values) != len(positions):
                raise ValueError(f"{key}: {len(values)} rows; expected one for each of the {len(positions)} vertices")
        if properties is not None and not isinstance(properties, Mapping):
            raise TypeError(f"properties: {type(properties).__name__}; expected a dictionary of arrays")
        numbers = []
        for key, given in (properties or {}).items():
            array = floats(given, f"properties[{key!r}]", None)
            is_of_faces = len(array) == given_faces and len(array) != len(positions)
            if not is_of_faces and len(array) != len(positions):
                raise ValueError(f"properties[{key!r}]: {len(array)} numbers; expected one for each of the "
                                 f"{len(positions)} vertices, or of the {given_faces} faces")
            if is_of_faces and of_face is not None:
                array = array[of_face]
            numbers.append((key, is_of_faces, array))
        if face_colors is not None:
            positions, indices, per_vertex, numbers = _with_face_colors(
                face_colors, given_faces, of_face, (positions, indices, per_vertex, numbers))
        encoded = None if image is None else Picture(image).png()
        if encoded is not None and uvs is None:
            raise ValueError("image: expected uvs beside it, which say where it lies on the mesh")
        normals_, uvs_, colors_ = (None if values is None else np.ascontiguousarray(values, np.float32)
                                   for values in per_vertex.values())
        self._mesh = _halfway.Mesh(name, positions, indices, normals_, uvs_, colors_, numbers, encoded, origin)
        self._shown: Any = None

    @classmethod
    def read(cls, path: str | os.PathLike[str], format: str | None = None, *, outside: bool = False) -> Mesh:
        """Reads a model: .obj, .gltf, .glb, .ply, .stl, .off, .3mf or .smf. With `outside`, files that it refers to may lie outside
        of its folder."""
        mesh = cls.__new__(cls)
        mesh._mesh = _halfway.Mesh.read(os.fspath(path), format, outside)
        mesh._shown = None
        return mesh

    @property
    def bounds(self) -> npt.NDArray[np.float64]:
        """The least and the greatest coordinates of what is drawn, of shape (2, 3)."""
        found = self._mesh.bounds()
        return np.array(found if found else [[0, 0, 0], [0, 0, 0]], np.float64) + self._mesh.origin()

    @property
    def vertices(self) -> npt.NDArray[np.floating[Any]]:
        """The vertices, of shape (n, 3); of a model of several parts, those of all. They are of type `float32`, or
        `float64` where they are so far away that `float32` would round them."""
        vertices = np.frombuffer(self._mesh.arrays()[0], np.float32).reshape(-1, 3)
        origin = self._mesh.origin()
        return vertices.astype(np.float64) + origin if any(origin) else vertices

    @property
    def faces(self) -> Indices:
        """The triangles, of shape (m, 3)."""
        return np.frombuffer(self._mesh.arrays()[1], np.uint32).reshape(-1, 3)

    @property
    def properties(self) -> list[str]:
        """The names of the numbers beside the mesh."""
        return list(self._mesh.properties())

    @property
    def warnings(self) -> list[str]:
        """Sentences about all that was skipped or corrected when a file was read."""
        return list(self._mesh.warnings())

    def __repr__(self) -> str:
        vertices, faces = self._mesh.counts()
        return f"<halfway.Mesh of {vertices} vertices and {faces} triangles>"

    def _repr_png_(self) -> bytes:
        from ._render import render

        return render(self, size=(400, 300)).png()


def linear_colors(colors: npt.ArrayLike, name: str) -> Floats:
    """Colours of shape (n, 4), linear: of bytes decoded from sRGB."""
    array = np.asarray(colors)
    if array.ndim != 2 or array.shape[1] not in (3, 4):
        raise ValueError(f"{name}: shape {array.shape}; expected (n, 3) or (n, 4)")
    if array.dtype == np.uint8:
        encoded = array / np.float64(255)
        decoded = np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)
        if array.shape[1] == 4:
            decoded[:, 3] = encoded[:, 3]
        array = decoded
    values = floats(array, name, array.shape[1])
    return values if values.shape[1] == 4 else np.c_[values, np.ones(len(values), np.float32)]


def _with_face_colors(colors: npt.ArrayLike, count: int, of_face: Any, parts: Any) -> Any:
    """The same mesh with corners of their own, which have the colours of their faces."""
    positions, indices, per_vertex, numbers = parts
    of_faces = linear_colors(colors, "face_colors")
    if len(of_faces) != count:
        raise ValueError(f"face_colors: {len(of_faces)} rows; expected one for each of the {count} faces")
    if per_vertex["colors"] is not None:
        raise ValueError("face_colors: cannot stand beside colors")
    if of_face is not None:
        of_faces = of_faces[of_face]
    corners = indices.reshape(-1)
    spread = {key: None if values is None else values[corners] for key, values in per_vertex.items()}
    spread["colors"] = np.repeat(of_faces, 3, axis=0)
    numbers = [(key, is_of_faces, array if is_of_faces else array[corners]) for key, is_of_faces, array in numbers]
    own = np.arange(len(corners), dtype=np.uint32).reshape(-1, 3)
    return np.ascontiguousarray(positions[corners]), own, spread, numbers


class Placed(NamedTuple):
    """A mesh to be drawn, where it stands, and keys of its object."""

    mesh: Mesh
    pose: npt.NDArray[np.float64] | None
    keys: dict[str, Any]


def placed(source: Any, faces: npt.ArrayLike | None = None, poses: Sequence[Any] | None = None) -> list[Placed]:
    """All meshes of what users have: arrays, a path, a mesh of this package or of another, or a list of those."""
    if faces is not None:
        found = [Placed(Mesh(source, faces), None, {})]
    elif isinstance(source, tuple) and len(source) == 2 and not isinstance(source[0], (str, Mesh)):
        found = [Placed(Mesh(source[0], source[1]), None, {})]
    elif isinstance(source, list):
        groups = [placed(item) for item in source]
        if poses is not None:
            if len(poses) != len(groups):
                raise ValueError(f"poses: {len(poses)} of them; expected one for each of the {len(groups)} meshes")
            groups = [_moved(group, pose, f"poses[{i}]") for i, (group, pose) in enumerate(zip(groups, poses))]
        return [item for group in groups for item in group]
    else:
        found = list(_of_object(source))
    return found if poses is None else _moved(found, poses, "poses")


def _moved(group: list[Placed], pose: Any, name: str) -> list[Placed]:
    if pose is None:
        return group
    moved = matrix(pose, name)
    return [item._replace(pose=moved if item.pose is None else moved @ item.pose) for item in group]


def _of_object(source: Any) -> Iterator[Placed]:
    if isinstance(source, Mesh):
        yield Placed(source, None, {})
    elif isinstance(source, (str, os.PathLike)):
        yield Placed(Mesh.read(source), None, {})
    elif hasattr(source, "geometry") and hasattr(source, "graph"):
        yield from _of_trimesh_scene(source)
    elif hasattr(source, "extract_surface"):
        yield _of_pyvista(source)
    elif hasattr(source, "points") and hasattr(source, "cells"):
        yield _of_meshio(source)
    elif hasattr(source, "vertices") and hasattr(source, "faces"):
        yield _of_trimesh(source)
    elif hasattr(source, "to_legacy") and hasattr(source, "triangle"):
        yield _of_open3d(source.to_legacy())
    elif hasattr(source, "vertices") and hasattr(source, "triangles"):
        yield _of_open3d(source)
    else:
        kind = type(source).__name__
        raise TypeError(f"mesh: {kind}; expected vertices and faces, a path, a halfway.Mesh, or a mesh of trimesh, "
                        "pyvista, Open3D or meshio")


def _of_trimesh_scene(scene: Any) -> Iterator[Placed]:
    made: dict[str, Placed] = {}
    for node in scene.graph.nodes_geometry:
        pose, name = scene.graph[node]
        if not hasattr(scene.geometry[name], "faces"):
            from ._scene import SceneWarning

            kind = type(scene.geometry[name]).__name__
            warnings.warn(f"{name!r} of the scene, a {kind} without faces, is not shown", SceneWarning, stacklevel=2)
            continue
        if name not in made:
            made[name] = _of_trimesh(scene.geometry[name])
        yield made[name]._replace(pose=matrix(pose, f"graph[{node!r}]"))


def _of_trimesh(mesh: Any) -> Placed:
    given: dict[str, Any] = {}
    keys: dict[str, Any] = {}
    visual: Any = getattr(mesh, "visual", None)
    kind = getattr(visual, "kind", None)
    if kind == "vertex":
        given["colors"] = np.asarray(visual.vertex_colors)
    elif kind == "face":
        given["face_colors"] = np.asarray(visual.face_colors)
    elif kind == "texture":
        material = visual.material
        image = getattr(material, "baseColorTexture", None) or getattr(material, "image", None)
        if image is not None and visual.uv is not None:
            given["uvs"], given["image"] = np.asarray(visual.uv), np.asarray(image.convert("RGBA"))[..., :3]
        else:
            keys = _of_trimesh_material(material)
    return Placed(Mesh(mesh.vertices, mesh.faces, **given), None, keys)


def _of_trimesh_material(material: Any) -> dict[str, Any]:
    """The keys of an object of this material. Bytes are sRGB, as trimesh shows them; factors of glTF are linear, though
    trimesh keeps them as bytes."""
    keys: dict[str, Any] = {}
    if hasattr(material, "baseColorFactor"):
        base = _unit(material.baseColorFactor, (1.0, 1.0, 1.0, 1.0))
        metallic, roughness = (1.0 if value is None else float(value) for value in
                               (material.metallicFactor, material.roughnessFactor))
        keys["material"] = metallic_roughness(base, metallic, roughness, _unit(material.emissiveFactor, (0.0, 0.0, 0.0)))
        if getattr(material, "doubleSided", False):
            keys["faces"] = "both"
        if material.alphaMode == "BLEND":
            keys |= {"blend": True, "material": keys["material"] | {"opacity": float(base[3])}}
    elif getattr(material, "diffuse", None) is not None:
        color = np.asarray(material.diffuse)
        color = color if color.dtype == np.uint8 else np.asarray(color, np.float32)
        keys["material"] = finish(linear_colors(color[None, :], "color")[0, :3].tolist())
    return keys


def _unit(color: Any, default: tuple[float, ...]) -> npt.NDArray[Any]:
    """A colour as numbers from 0 to 1, with as many as the default has."""
    if color is None:
        return np.array(default)
    values = np.asarray(color)
    values = values / 255.0 if values.dtype.kind in "iu" else values.astype(float)
    return np.concatenate([values, default[len(values):]])[:len(default)]


def metallic_roughness(base: npt.NDArray[Any], metallic: float, roughness: float,
                       emission: npt.NDArray[Any]) -> dict[str, Any]:
    """The classic material that looks about like a metallic-roughness one, as halfway reads glTF."""
    color = np.clip(base[:3], 0, 1)
    alpha = max(min(max(roughness, 0.0), 1.0) ** 2, 1e-6)
    shininess = float(np.clip(2 / (alpha * alpha) - 2, 1, 10_000))
    f0 = 0.04 + (color - 0.04) * metallic
    largest = float(f0.max())
    peak = max(min((shininess + 8) / 8, 1 / largest), 1.0) if largest > 0 else 1.0
    return {"ambient": color.tolist(), "diffuse": (color * (1 - metallic)).tolist(), "specular": (f0 * peak).tolist(),
            "emission": np.clip(emission, 0, None).tolist(), "shininess": shininess}


def _of_pyvista(mesh: Any) -> Placed:
    surface = mesh
    if not hasattr(type(mesh), "strips"):
        with warnings.catch_warnings():
            # Of defaults that are to change.
            warnings.simplefilter("ignore")
            surface = mesh.extract_surface()
    surface = surface.triangulate()
    faces = np.asarray(surface.faces).reshape(-1, 4)[:, 1:]
    if not len(faces):
        raise ValueError("mesh: a pyvista mesh without faces; expected at least one")
    given: dict[str, Any] = {}
    numbers: dict[str, Any] = {}
    for is_of_faces, data in ((True, surface.cell_data), (False, surface.point_data)):
        for key in data.keys():
            values = np.asarray(data[key])
            if values.ndim == 1:
                numbers[key] = values
            elif values.dtype == np.uint8 and values.shape[1] in (3, 4) and key == surface.active_scalars_name:
                given["face_colors" if is_of_faces else "colors"] = values
    if "face_colors" in given:
        given.pop("colors", None)
    # pyvista shows both sides.
    return Placed(Mesh(surface.points, faces, properties=numbers, **given), None, {"faces": "both"})


CORNERS = {"triangle": 3, "quad": 4, "tetra": 4, "pyramid": 5, "wedge": 6, "hexahedron": 8}
"""The kinds of meshio's cells that have a surface, and how many of their points are corners; the rest are on their edges."""

SIDES: dict[str, tuple[tuple[int, ...], ...]] = {
    "triangle": ((0, 1, 2),),
    "quad": ((0, 1, 2, 3),),
    "tetra": ((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)),
    "pyramid": ((0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)),
    "wedge": ((0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)),
    "hexahedron": ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)),
}


def _of_meshio(mesh: Any) -> Placed:
    """Its triangles and quadrilaterals, and the sides of solid cells that no two share."""
    points = np.asarray(mesh.points)
    if points.ndim == 2 and points.shape[1] == 2:
        points = np.c_[points, np.zeros(len(points))]
    # The number of the cell, counted over all blocks, is kept for what is said of cells.
    flat: list[tuple[Indices, Any]] = []
    solid: list[tuple[npt.NDArray[Any], Any]] = []
    first = 0
    for block in mesh.cells:
        kind, cells = block.type.rstrip("0123456789"), np.asarray(block.data)
        own = np.arange(first, first + len(cells))
        first += len(cells)
        if kind not in CORNERS or not len(cells):
            continue
        if kind in ("triangle", "quad"):
            indices, of_face = triangles(cells[:, :CORNERS[kind]], len(points))
            flat.append((indices, own if of_face is None else own[of_face]))
        else:
            solid += [(cells[:, list(side)], own) for side in SIDES[kind]]
    for sides, own in _outside(solid):
        indices, of_face = triangles(sides, len(points))
        flat.append((indices, own if of_face is None else own[of_face]))
    if not flat:
        kinds = ", ".join(sorted({block.type for block in mesh.cells})) or "no cells"
        raise ValueError(f"mesh: {kinds}; expected cells of {', '.join(CORNERS)}")
    faces, of_cell = (np.concatenate([part[i] for part in flat]) for i in (0, 1))
    numbers: dict[str, Any] = {}
    for key, blocks in mesh.cell_data.items():
        values = [np.asarray(block) for block in blocks]
        if all(block.ndim == 1 for block in values):
            numbers[key] = np.concatenate(values)[of_cell]
    numbers |= {key: values for key, values in mesh.point_data.items() if np.asarray(values).ndim == 1}
    return Placed(Mesh(points, faces, properties=numbers), None, {"faces": "both"})


def _outside(sides: list[tuple[npt.NDArray[Any], Any]]) -> Iterator[tuple[npt.NDArray[Any], Any]]:
    """The sides of solid cells that belong to one cell only."""
    for corners in (3, 4):
        of_this = [(side, own) for side, own in sides if side.shape[1] == corners]
        if of_this:
            all_sides, owners = (np.concatenate([part[i] for part in of_this]) for i in (0, 1))
            _, places, counts = np.unique(np.sort(all_sides, axis=1), axis=0, return_index=True, return_counts=True)
            kept = np.sort(places[counts == 1])
            if len(kept):
                yield all_sides[kept], owners[kept]


def _of_open3d(mesh: Any) -> Placed:
    given: dict[str, Any] = {}
    vertices, faces = np.asarray(mesh.vertices), np.asarray(mesh.triangles)
    colors, normals = np.asarray(mesh.vertex_colors), np.asarray(mesh.vertex_normals)
    if len(colors) == len(vertices):
        # Open3D's numbers are those of an image, 0 to 1.
        given["colors"] = np.round(np.clip(colors, 0, 1) * 255).astype(np.uint8)
    if len(normals) == len(vertices):
        given["normals"] = normals
    uvs, images = np.asarray(mesh.triangle_uvs), list(getattr(mesh, "textures", []))
    if len(uvs) == faces.size and images and np.asarray(images[0]).size:
        corners = faces.reshape(-1)
        given = {key: values[corners] for key, values in given.items() if key == "normals"}
        # The first row of Open3D's images is the lowest.
        given |= {"uvs": uvs, "image": np.asarray(images[0])[::-1]}
        vertices, faces = vertices[corners], np.arange(faces.size).reshape(-1, 3)
    return Placed(Mesh(vertices, faces, **given), None, {})


def finish(color: Sequence[float]) -> dict[str, Any]:
    """The material of a surface of which only the colour is known, as keys of a scene."""
    return {"ambient": list(color), "diffuse": list(color), "specular": [0.12] * 3, "shininess": 40.0}
