"""The part of pyrender's interface that draws into arrays, drawn by halfway: no OpenGL, no display, no driver.

    import halfway.pyrender as pyrender

    scene = pyrender.Scene(ambient_light=[0.1, 0.1, 0.1])
    scene.add(pyrender.Mesh.from_trimesh(mesh))
    scene.add(pyrender.PerspectiveCamera(yfov=1.0), pose=camera_pose)
    scene.add(pyrender.DirectionalLight(intensity=3.0), pose=light_pose)
    color, depth = pyrender.OffscreenRenderer(640, 480).render(scene)

Names, arguments and results are pyrender's. Silhouettes, depth and segmentation are the same but for pixels at edges.
These differ:

- Materials are classic ones that look about like pyrender's metallic-roughness ones: a Blinn–Phong highlight as wide and,
  seen from its middle, as bright as pyrender's; no Fresnel term, no masking term. A metallicRoughnessTexture is left out,
  with a warning.
- There are no shadows: SHADOWS_DIRECTIONAL, SHADOWS_POINT and SHADOWS_SPOT warn once.
- All lights of a scene light every mesh; pyrender takes the nearest four of each kind.
- Colours are encoded by the sRGB curve, not by a power of 1/2.2: up to 8 steps of 255 in dark colours. Vertex colours
  multiply diffuse and ambient light; highlights are multiplied by their mean.
- The depth of an orthographic camera is the length along its axis; pyrender decodes it as a perspective camera's.
- Wireframes have one colour, show all edges, and their depth is 0.
- Points, lines, morph targets and the interactive Viewer are errors.
"""

from __future__ import annotations

import hashlib
import os
import tempfile
import warnings
import weakref
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from ._arguments import matrix
from ._mesh import Mesh as DrawnMesh
from ._parts import placed_by
from ._picture import Picture
from ._scene import Scene as DrawnScene
from ._scene import SceneWarning

Array: TypeAlias = npt.NDArray[Any]
Pose: TypeAlias = npt.ArrayLike

DEFAULT_Z_NEAR = 0.05
DEFAULT_Z_FAR = 100.0


class RenderFlags:
    """Flags of `OffscreenRenderer.render`, combined by `|`."""

    NONE = 0
    DEPTH_ONLY = 1
    """Only the depth is returned."""
    OFFSCREEN = 2
    FLIP_WIREFRAME = 4
    ALL_WIREFRAME = 8
    ALL_SOLID = 16
    SHADOWS_DIRECTIONAL = 32
    SHADOWS_POINT = 64
    SHADOWS_SPOT = 128
    SHADOWS_ALL = 32 | 64 | 128
    VERTEX_NORMALS = 256
    FACE_NORMALS = 512
    SKIP_CULL_FACES = 1024
    """Back faces are drawn, too."""
    RGBA = 2048
    """The colours have a fourth channel, the opacity."""
    FLAT = 4096
    """Colours are not lit."""
    SEG = 8192
    """Nodes have the colours of `seg_node_map`."""


class GLTF:
    """Numbers that glTF has for kinds of primitives."""

    POINTS = 0
    LINES = 1
    LINE_LOOP = 2
    LINE_STRIP = 3
    TRIANGLES = 4
    TRIANGLE_STRIP = 5
    TRIANGLE_FAN = 6


def _vector(value: Any, length: int, name: str) -> Array:
    """A colour as pyrender takes it: whole numbers are of 255, what is missing is 1."""
    array = np.asarray(value)
    if array.ndim == 0:
        array = np.repeat(array, length)
    array = array.squeeze()
    if array.ndim != 1 or array.dtype.kind not in "fiu":
        raise ValueError(f"{name}: {value!r}; expected {length} numbers")
    color = array / 255.0 if array.dtype.kind in "iu" else array.astype(float)
    return np.concatenate([color, np.ones(length)])[:length].astype(np.float32)


_warned: set[str] = set()


def _warn_once(sentence: str) -> None:
    if sentence not in _warned:
        _warned.add(sentence)
        warnings.warn(sentence, SceneWarning, stacklevel=4)


class Camera:
    """A camera; it looks along −Z of its node, with +Y up."""

    def __init__(self, znear: float = DEFAULT_Z_NEAR, zfar: float | None = DEFAULT_Z_FAR, name: str | None = None) -> None:
        if znear < 0 or (zfar is not None and zfar <= znear):
            raise ValueError(f"znear: {znear}, zfar: {zfar}; expected 0 or more, and more than that")
        self.name, self.znear, self.zfar = name, float(znear), None if zfar is None else float(zfar)

    def get_projection_matrix(self, width: int | None = None, height: int | None = None) -> Array:
        """The matrix of OpenGL for a picture of this size."""
        raise NotImplementedError

    def _depth_rows(self, projection: Array) -> Array:
        n, f = self.znear, self.zfar
        projection[3, 2] = -1.0
        projection[2, 2:] = (-1.0, -2.0 * n) if f is None else ((f + n) / (n - f), 2 * f * n / (n - f))
        return projection

    def _keys(self, width: int, height: int) -> dict[str, Any]:
        p = self.get_projection_matrix(width, height)
        return {
            "near": max(self.znear, 1e-6),
            "intrinsics": {
                "focal": [p[0, 0] * width / 2, p[1, 1] * height / 2],
                "center": [(1 - p[0, 2]) * width / 2, (1 + p[1, 2]) * height / 2],
                "size": [width, height],
            },
        }


class PerspectiveCamera(Camera):
    """A perspective camera with a vertical field of view of `yfov` radians."""

    def __init__(self, yfov: float, znear: float = DEFAULT_Z_NEAR, zfar: float | None = None,
                 aspectRatio: float | None = None, name: str | None = None) -> None:
        super().__init__(znear, zfar, name)
        if not 0 < yfov < np.pi:
            raise ValueError(f"yfov: {yfov}; expected radians, above 0 and below π")
        self.yfov, self.aspectRatio = float(yfov), aspectRatio

    def get_projection_matrix(self, width: int | None = None, height: int | None = None) -> Array:
        """The matrix of OpenGL for a picture of this size."""
        aspect = self.aspectRatio
        if aspect is None:
            if not width or not height:
                raise ValueError("aspectRatio: expected a number, or width and height of the picture")
            aspect = width / height
        t = np.tan(self.yfov / 2)
        return self._depth_rows(np.diag([1 / (aspect * t), 1 / t, 0.0, 0.0]))


class OrthographicCamera(Camera):
    """A camera without perspective, which shows from −ymag to ymag, and as much at the sides as the picture is wide."""

    def __init__(self, xmag: float, ymag: float, znear: float = DEFAULT_Z_NEAR, zfar: float = DEFAULT_Z_FAR,
                 name: str | None = None) -> None:
        super().__init__(znear, zfar, name)
        if xmag <= 0 or ymag <= 0:
            raise ValueError(f"xmag: {xmag}, ymag: {ymag}; expected numbers above 0")
        self.xmag, self.ymag = float(xmag), float(ymag)

    def get_projection_matrix(self, width: int | None = None, height: int | None = None) -> Array:
        """The matrix of OpenGL for a picture of this size."""
        assert self.zfar is not None
        n, f = self.znear, self.zfar
        xmag = self.xmag if not width or not height else width / height * self.ymag
        projection = np.diag([1 / xmag, 1 / self.ymag, 2 / (n - f), 1.0])
        projection[2, 3] = (f + n) / (n - f)
        return projection

    def _keys(self, width: int, height: int) -> dict[str, Any]:
        return {"height": 2 * self.ymag, "near": self.znear, "far": self.zfar}


class IntrinsicsCamera(Camera):
    """A calibrated camera: focal lengths and principal point in pixels from the upper left corner."""

    def __init__(self, fx: float, fy: float, cx: float, cy: float, znear: float = DEFAULT_Z_NEAR,
                 zfar: float | None = DEFAULT_Z_FAR, name: str | None = None) -> None:
        super().__init__(znear, zfar, name)
        self.fx, self.fy, self.cx, self.cy = float(fx), float(fy), float(cx), float(cy)

    def get_projection_matrix(self, width: int | None = None, height: int | None = None) -> Array:
        """The matrix of OpenGL for a picture of this size."""
        if not width or not height:
            raise ValueError("expected width and height of the picture")
        projection = np.diag([2 * self.fx / width, 2 * self.fy / height, 0.0, 0.0])
        projection[:2, 2] = 1 - 2 * self.cx / width, 2 * self.cy / height - 1
        return self._depth_rows(projection)


class Light:
    """A light of linear `color` and of `intensity` in lux (directional) or candela (point and spot)."""

    def __init__(self, color: Any = None, intensity: float | None = None, name: str | None = None) -> None:
        self.color = np.ones(3, np.float32) if color is None else _vector(color, 3, "color")
        self.intensity = 1.0 if intensity is None else float(intensity)
        self.name = name

    def _keys(self, pose: Array) -> dict[str, Any]:
        # A surface gives back its colour over π of the light.
        color = (np.asarray(self.color, float) * self.intensity / np.pi).tolist()
        return {"diffuse": color, "specular": color}


class DirectionalLight(Light):
    """Light along −Z of its node."""

    def _keys(self, pose: Array) -> dict[str, Any]:
        return {"kind": "directional", "direction": (-pose[:3, 2]).tolist(), **super()._keys(pose)}


class PointLight(Light):
    """Light from the place of its node, weaker with the square of the distance. As in pyrender, `range` ends nothing."""

    def __init__(self, color: Any = None, intensity: float | None = None, range: float | None = None,
                 name: str | None = None) -> None:
        super().__init__(color, intensity, name)
        self.range = range

    def _keys(self, pose: Array) -> dict[str, Any]:
        return {"kind": "point", "position": pose[:3, 3].tolist(), "attenuation": [0, 0, 1], **super()._keys(pose)}


class SpotLight(Light):
    """Light from the place of its node into a cone along −Z; the angles from the axis are radians."""

    def __init__(self, color: Any = None, intensity: float | None = None, range: float | None = None,
                 innerConeAngle: float = 0.0, outerConeAngle: float = np.pi / 4.0, name: str | None = None) -> None:
        super().__init__(color, intensity, name)
        if not 0 <= innerConeAngle <= outerConeAngle <= np.pi / 2 + 1e-9:
            raise ValueError(f"innerConeAngle: {innerConeAngle}, outerConeAngle: {outerConeAngle}; expected radians, 0 to "
                             "the outer one, which is at most π/2")
        self.range, self.innerConeAngle, self.outerConeAngle = range, float(innerConeAngle), float(outerConeAngle)

    def _keys(self, pose: Array) -> dict[str, Any]:
        cutoff, inner = np.degrees([self.outerConeAngle, self.innerConeAngle])
        return {
            "kind": "spot", "position": pose[:3, 3].tolist(), "direction": (-pose[:3, 2]).tolist(),
            "attenuation": [0, 0, 1], "cutoff_deg": min(float(cutoff), 90.0), "inner_deg": min(float(inner), 90.0),
            **super()._keys(pose),
        }


class Material:
    """The properties that all materials have."""

    def __init__(self, name: str | None = None, normalTexture: Any = None, occlusionTexture: Any = None,
                 emissiveTexture: Any = None, emissiveFactor: Any = None, alphaMode: str | None = None,
                 alphaCutoff: float | None = None, doubleSided: bool = False, smooth: bool = True,
                 wireframe: bool = False) -> None:
        if alphaMode not in (None, "OPAQUE", "MASK", "BLEND"):
            raise ValueError(f"alphaMode: {alphaMode!r}; expected OPAQUE, MASK or BLEND")
        self.name = name
        self.normalTexture, self.occlusionTexture, self.emissiveTexture = normalTexture, occlusionTexture, emissiveTexture
        self.emissiveFactor = np.zeros(3, np.float32) if emissiveFactor is None else _vector(emissiveFactor, 3,
                                                                                            "emissiveFactor")
        self.alphaMode = alphaMode or "OPAQUE"
        self.alphaCutoff = 0.5 if alphaCutoff is None else float(alphaCutoff)
        self.doubleSided, self.smooth, self.wireframe = bool(doubleSided), smooth, wireframe


class MetallicRoughnessMaterial(Material):
    """A material of glTF: linear base colour, metallic and roughness, 0 to 1."""

    def __init__(self, name: str | None = None, normalTexture: Any = None, occlusionTexture: Any = None,
                 emissiveTexture: Any = None, emissiveFactor: Any = None, alphaMode: str | None = None,
                 alphaCutoff: float | None = None, doubleSided: bool = False, smooth: bool = True,
                 wireframe: bool = False, baseColorFactor: Any = None, baseColorTexture: Any = None,
                 metallicFactor: float | None = 1.0, roughnessFactor: float | None = 1.0,
                 metallicRoughnessTexture: Any = None) -> None:
        super().__init__(name, normalTexture, occlusionTexture, emissiveTexture, emissiveFactor, alphaMode, alphaCutoff,
                         doubleSided, smooth, wireframe)
        self.baseColorFactor = np.ones(4, np.float32) if baseColorFactor is None else _vector(baseColorFactor, 4,
                                                                                             "baseColorFactor")
        self.baseColorTexture, self.metallicRoughnessTexture = baseColorTexture, metallicRoughnessTexture
        self.metallicFactor = 1.0 if metallicFactor is None else float(metallicFactor)
        self.roughnessFactor = 1.0 if roughnessFactor is None else float(roughnessFactor)

    def _classic(self) -> dict[str, Any]:
        """The classic material that looks about like it. The exponent 2/α² − 2 is that of halfway's reading of glTF; the peak
        is the one of pyrender's distribution, D/4 = 1/(4πα²), as intensities here are over π."""
        base = np.clip(np.asarray(self.baseColorFactor, float), 0, 1)
        metallic, roughness = np.clip([self.metallicFactor, self.roughnessFactor], 0, 1)
        alpha = max(float(roughness), 0.04) ** 2
        shininess = float(np.clip(2 / (alpha * alpha) - 2, 1, 10_000))
        f0 = 0.04 + (base[:3] - 0.04) * metallic
        peak = 1 / (4 * alpha * alpha)
        return {
            "ambient": base[:3].tolist(), "diffuse": (base[:3] * (1 - metallic)).tolist(),
            "specular": (f0 * peak).tolist(), "emission": np.asarray(self.emissiveFactor, float).tolist(),
            "shininess": shininess, "opacity": 1.0 if self.alphaMode == "OPAQUE" else float(base[3]),
        }


def _default_material(color: Any) -> MetallicRoughnessMaterial:
    return MetallicRoughnessMaterial(alphaMode="BLEND", baseColorFactor=color, metallicFactor=0.2, roughnessFactor=0.8)


class _Images:
    """The images of materials as files, which scenes name."""

    def __init__(self) -> None:
        self._folder: tempfile.TemporaryDirectory[str] | None = None
        self._known: dict[int, tuple[Any, str]] = {}

    def file(self, texture: Any) -> str:
        """The file of an image, named for its contents."""
        known = self._known.get(id(texture))
        if known is not None and known[0] is texture and not isinstance(texture, np.ndarray):
            return known[1]
        picture = Picture(_image(texture))
        if self._folder is None:
            self._folder = tempfile.TemporaryDirectory(prefix="halfway-pyrender-")
        name = hashlib.sha256(f"{picture.shape}".encode() + np.asarray(picture).tobytes()).hexdigest()
        path = os.path.join(self._folder.name, f"{name}.png")
        if not os.path.exists(path):
            picture.save(path)
        self._known[id(texture)] = texture, path
        return path

    def clear(self) -> None:
        """Removes the files."""
        self._known.clear()
        if self._folder is not None:
            self._folder.cleanup()
            self._folder = None


def _image(texture: Any) -> Array:
    """The bytes of a texture: an array, an image of Pillow, or what holds one as `source`."""
    source = getattr(texture, "source", texture)
    if hasattr(source, "convert"):
        source = source.convert("RGBA")
    array = np.asarray(source)
    if array.dtype.kind == "f":
        array = np.round(np.clip(array, 0, 1) * 255).astype(np.uint8)
    if array.ndim == 3 and array.shape[2] in (1, 2):
        array = np.repeat(array[..., :1], 3, axis=2)
    return array.astype(np.uint8, copy=False)


def _decoded(encoded: Array) -> Array:
    decoded: Array = np.where(encoded <= 0.04045, encoded / 12.92, ((np.maximum(encoded, 0) + 0.055) / 1.055) ** 2.4)
    return decoded


class Primitive:
    """Triangles with one material."""

    def __init__(self, positions: npt.ArrayLike, normals: npt.ArrayLike | None = None, tangents: Any = None,
                 texcoord_0: npt.ArrayLike | None = None, texcoord_1: Any = None, color_0: npt.ArrayLike | None = None,
                 joints_0: Any = None, weights_0: Any = None, indices: npt.ArrayLike | None = None,
                 material: Material | None = None, mode: int | None = None, targets: Any = None,
                 poses: npt.ArrayLike | None = None) -> None:
        if mode not in (None, GLTF.TRIANGLES):
            raise NotImplementedError("mode: halfway.pyrender draws triangles; points and lines are drawn from a PLY, OBJ or "
                                      "glTF file by halfway.render")
        self.positions = np.array(positions, np.float32)
        self.normals = None if normals is None else np.array(normals, np.float32)
        self.texcoord_0 = None if texcoord_0 is None else np.array(texcoord_0, np.float32)[:, :2]
        self.color_0 = None if color_0 is None else _colors(color_0, len(self.positions))
        self.indices = None if indices is None else np.array(indices, np.uint32)
        self.material = material if material is not None else MetallicRoughnessMaterial()
        self.poses = None if poses is None else np.array(poses, np.float32).reshape(-1, 4, 4)
        self.mode = GLTF.TRIANGLES
        self._made: dict[bool, DrawnMesh] = {}

    @property
    def bounds(self) -> Array:
        """The least and the greatest coordinates, of shape (2, 3)."""
        points = self.positions
        if self.poses is not None:
            points = np.concatenate([points @ pose[:3, :3].T + pose[:3, 3] for pose in self.poses])
        return np.array([points.min(axis=0), points.max(axis=0)])

    @property
    def is_transparent(self) -> bool:
        """Whether something is seen through it."""
        material = self.material
        if material.alphaMode != "BLEND":
            return False
        texture = getattr(material, "baseColorTexture", None)
        if texture is not None and self.texcoord_0 is not None:
            image = _image(texture)
            if image.ndim == 3 and image.shape[2] == 4 and (image[..., 3] < 255).any():
                return True
        is_clear = isinstance(material, MetallicRoughnessMaterial) and material.baseColorFactor[3] < 1
        return bool(is_clear or (self.color_0 is not None and (self.color_0[:, 3] < 1).any()))

    def _drawn(self, flat: bool) -> DrawnMesh:
        """The mesh that halfway draws; with `flat` its colours are taken as encoded."""
        if flat not in self._made:
            colors = self.color_0
            if colors is not None and flat:
                colors = np.c_[_decoded(colors[:, :3]), colors[:, 3]]
            faces = self.indices if self.indices is not None else np.arange(len(self.positions)).reshape(-1, 3)
            self._made[flat] = DrawnMesh(self.positions, faces, normals=self.normals, uvs=self.texcoord_0,
                                         colors=None if colors is None else colors.astype(np.float32))
        return self._made[flat]

    def _factor(self, flat: bool) -> Array:
        factor = np.asarray(getattr(self.material, "baseColorFactor", np.ones(4)), float).clip(0, 1)
        return np.append(_decoded(factor[:3]), factor[3]) if flat else factor

    def _keys(self, flags: int, only_surfaces: bool, images: _Images) -> dict[str, Any]:
        """The keys of its object."""
        material, flat = self.material, bool(flags & RenderFlags.FLAT)
        keys: dict[str, Any] = {"normals": "keep" if self.normals is not None else "face"}
        if only_surfaces:
            return keys
        if getattr(material, "metallicRoughnessTexture", None) is not None:
            _warn_once("metallicRoughnessTexture is not drawn by halfway.pyrender")
        if isinstance(material, MetallicRoughnessMaterial):
            keys["material"] = material._classic()
            if self.color_0 is not None and len(self.color_0):
                tint = self.color_0[:, :3].mean(axis=0)
                keys["material"]["specular"] = (keys["material"]["specular"] * tint).tolist()
            if flat:
                color = self._factor(True)[:3].tolist()
                keys["material"] = {"ambient": color, "diffuse": color, "opacity": keys["material"]["opacity"]}
        if self.texcoord_0 is not None:
            maps = {}
            for name, texture in (("color", getattr(material, "baseColorTexture", None)),
                                  ("normal", material.normalTexture), ("occlusion", material.occlusionTexture),
                                  ("emission", material.emissiveTexture)):
                if texture is not None and (name == "color" or not flat):
                    maps[name] = {"path": images.file(texture)}
            if "color" in maps and not flat and getattr(material, "metallicFactor", 0.0) > 0.5:
                # A metal reflects in its colour.
                maps["specular"] = maps["color"]
            if maps:
                keys["maps"] = maps
        if self.is_transparent:
            keys["blend"] = True
        elif material.alphaMode == "MASK":
            keys["mask"] = material.alphaCutoff
        if material.doubleSided or flags & RenderFlags.SKIP_CULL_FACES:
            keys["faces"] = "both"
        is_wire = material.wireframe != bool(flags & RenderFlags.FLIP_WIREFRAME) or flags & RenderFlags.ALL_WIREFRAME
        if is_wire and not flags & RenderFlags.ALL_SOLID:
            color = self._factor(flat)[:3].tolist()
            keys["edges"] = {"which": "all", "surface": False, "width": 1, "color": color}
        return keys


def _colors(colors: npt.ArrayLike, count: int) -> Array:
    """Colours of vertices, 0 to 1, with an opacity. As in pyrender, bytes are linear."""
    array = np.asarray(colors)
    array = array / 255.0 if array.dtype.kind in "iu" else array.astype(float)
    if array.ndim == 1:
        array = np.tile(array, (count, 1))
    return array if array.shape[1] == 4 else np.c_[array, np.ones(len(array))]


class Mesh:
    """Primitives that are drawn together."""

    def __init__(self, primitives: list[Primitive], name: str | None = None, weights: Any = None,
                 is_visible: bool = True) -> None:
        self.primitives, self.name, self.weights, self.is_visible = primitives, name, weights, is_visible

    @property
    def bounds(self) -> Array:
        """The least and the greatest coordinates, of shape (2, 3)."""
        of_each = np.array([primitive.bounds for primitive in self.primitives])
        return np.array([of_each[:, 0].min(axis=0), of_each[:, 1].max(axis=0)])

    @property
    def centroid(self) -> Array:
        """The middle of the bounds."""
        return np.asarray(self.bounds.mean(axis=0))

    @property
    def extents(self) -> Array:
        """The lengths of the bounds."""
        return np.asarray(self.bounds[1] - self.bounds[0])

    @property
    def scale(self) -> float:
        """The diagonal of the bounds."""
        return float(np.linalg.norm(self.extents))

    @property
    def is_transparent(self) -> bool:
        """Whether something is seen through it."""
        return any(primitive.is_transparent for primitive in self.primitives)

    @staticmethod
    def from_points(points: Any, colors: Any = None, normals: Any = None, is_visible: bool = True,
                    poses: Any = None) -> Mesh:
        """Points cannot be drawn here: an error says so."""
        raise NotImplementedError("Mesh.from_points: halfway.pyrender draws triangles; write the points as a PLY file and draw "
                                  "that by halfway.render, or give a small sphere as `poses` of Mesh.from_trimesh")

    @staticmethod
    def from_trimesh(mesh: Any, material: Material | None = None, is_visible: bool = True,
                     poses: npt.ArrayLike | None = None, wireframe: bool = False, smooth: bool = True) -> Mesh:
        """The mesh of a `trimesh.Trimesh`, or of several. With `smooth` its normals are those of vertices, else of faces."""
        if isinstance(mesh, (list, tuple, set, np.ndarray)):
            meshes = list(mesh)
        elif hasattr(mesh, "vertices") and hasattr(mesh, "faces"):
            meshes = [mesh]
        else:
            raise TypeError(f"mesh: {type(mesh).__name__}; expected a Trimesh or a list of them")
        return Mesh([_of_trimesh(part, material, poses, wireframe, smooth) for part in meshes], is_visible=is_visible)


def _of_trimesh(mesh: Any, material: Material | None, poses: npt.ArrayLike | None, wireframe: bool,
                smooth: bool) -> Primitive:
    faces = np.asarray(mesh.faces)
    corners = faces.reshape(-1)

    def spread(values: Any) -> Array:
        return np.array(values) if smooth else np.asarray(values)[corners]

    colors, uvs, own = None, None, material
    visual = mesh.visual
    kind = visual.kind if visual.defined else None
    if kind == "vertex" and material is None:
        colors, own = spread(visual.vertex_colors), _default_material([1.0, 1.0, 1.0, 1.0])
    elif kind == "face" and material is None:
        if smooth:
            raise ValueError("smooth: a mesh with colours of faces cannot be smooth; expected smooth=False")
        colors, own = np.repeat(visual.face_colors, 3, axis=0), _default_material([1.0, 1.0, 1.0, 1.0])
    elif kind == "texture":
        if visual.uv is not None:
            uvs = spread(visual.uv)
        own = material if material is not None else _of_trimesh_material(visual.material)
    if own is None:
        own = _default_material([0.3, 0.3, 0.3, 1.0])
    if wireframe != own.wireframe:
        own = _copy(own)
        own.wireframe = wireframe
    return Primitive(
        positions=spread(mesh.vertices),
        normals=np.array(mesh.vertex_normals) if smooth else np.repeat(mesh.face_normals, 3, axis=0),
        texcoord_0=uvs, color_0=colors, indices=faces if smooth else None, material=own, poses=poses,
    )


def _copy(material: Material) -> Material:
    import copy

    return copy.copy(material)


def _of_trimesh_material(material: Any) -> Material | None:
    if isinstance(material, Material):
        return material
    if hasattr(material, "baseColorFactor"):
        names = ("normalTexture", "occlusionTexture", "emissiveTexture", "emissiveFactor", "baseColorFactor",
                 "baseColorTexture", "metallicFactor", "roughnessFactor", "metallicRoughnessTexture", "alphaCutoff")
        return MetallicRoughnessMaterial(alphaMode="BLEND", doubleSided=bool(material.doubleSided),
                                         **{name: getattr(material, name) for name in names})
    if hasattr(material, "diffuse"):
        shininess = getattr(material, "kwargs", {}).get("Ns", 1.0)
        shininess = float(shininess[0] if isinstance(shininess, list) else shininess)
        return MetallicRoughnessMaterial(alphaMode="BLEND", roughnessFactor=(2 / (shininess + 2)) ** 0.25,
                                         baseColorFactor=material.diffuse, baseColorTexture=material.image)
    return None


class Node:
    """A place in a scene, with a mesh, a camera or a light, and children that move with it."""

    def __init__(self, name: str | None = None, camera: Camera | None = None, children: Iterable[Node] | None = None,
                 skin: Any = None, matrix: Pose | None = None, mesh: Mesh | None = None,
                 rotation: npt.ArrayLike | None = None, scale: npt.ArrayLike | None = None,
                 translation: npt.ArrayLike | None = None, weights: Any = None, light: Light | None = None) -> None:
        self.name, self.camera, self.mesh, self.light, self.weights, self.skin = name, camera, mesh, light, weights, skin
        self.children: list[Node] = list(children or ())
        self._parent: Node | None = None
        self._matrix = _of_parts(translation, rotation, scale) if matrix is None else _checked(matrix, "matrix")

    @property
    def matrix(self) -> Array:
        """The matrix of 4 by 4 from the node to its parent: a copy, which can be set as a whole."""
        return self._matrix.copy()

    @matrix.setter
    def matrix(self, value: Pose) -> None:
        self._matrix = _checked(value, "matrix")

    @property
    def translation(self) -> Array:
        """Where it stands in its parent."""
        return self._matrix[:3, 3].copy()

    @translation.setter
    def translation(self, value: npt.ArrayLike) -> None:
        self._matrix = _of_parts(value, self.rotation, self.scale)

    @property
    def scale(self) -> Array:
        """The lengths of its axes."""
        return np.asarray(np.linalg.norm(self._matrix[:3, :3], axis=0))

    @scale.setter
    def scale(self, value: npt.ArrayLike) -> None:
        self._matrix = _of_parts(self.translation, self.rotation, value)

    @property
    def rotation(self) -> Array:
        """A quaternion x, y, z, w."""
        m = self._matrix[:3, :3] / self.scale
        # The vector of the largest eigenvalue: right whatever the angle.
        k = np.array([
            [m[0, 0] - m[1, 1] - m[2, 2], m[1, 0] + m[0, 1], m[2, 0] + m[0, 2], m[2, 1] - m[1, 2]],
            [m[1, 0] + m[0, 1], m[1, 1] - m[0, 0] - m[2, 2], m[2, 1] + m[1, 2], m[0, 2] - m[2, 0]],
            [m[2, 0] + m[0, 2], m[2, 1] + m[1, 2], m[2, 2] - m[0, 0] - m[1, 1], m[1, 0] - m[0, 1]],
            [m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1], m[0, 0] + m[1, 1] + m[2, 2]],
        ])
        q = np.linalg.eigh(k)[1][:, -1]
        return np.asarray(-q if q[3] < 0 else q)

    @rotation.setter
    def rotation(self, value: npt.ArrayLike) -> None:
        self._matrix = _of_parts(self.translation, value, self.scale)


def _checked(pose: Pose, name: str) -> Array:
    matrix(pose, name)
    return np.array(pose, float)


def _of_parts(translation: npt.ArrayLike | None, rotation: npt.ArrayLike | None, scale: npt.ArrayLike | None) -> Array:
    x, y, z, w = np.asarray((0, 0, 0, 1) if rotation is None else rotation, float)
    if abs(x * x + y * y + z * z + w * w - 1) > 2e-3:
        raise ValueError(f"rotation: {rotation!r}; expected a quaternion x, y, z, w of length 1")
    pose = np.eye(4)
    pose[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    pose[:3, :3] *= np.asarray((1, 1, 1) if scale is None else scale, float)
    pose[:3, 3] = (0, 0, 0) if translation is None else translation
    return pose


class Scene:
    """Nodes with meshes, lights and cameras. The first camera that is added draws, unless `main_camera_node` is set."""

    def __init__(self, nodes: Iterable[Node] | None = None, bg_color: Any = None, ambient_light: Any = None,
                 name: str | None = None) -> None:
        self.name = name
        self.bg_color, self.ambient_light = bg_color, ambient_light
        # In the order in which they were added.
        self._nodes: dict[Node, None] = {}
        self._main_camera_node: Node | None = None
        given = list(nodes or ())
        children = {child for node in given for child in node.children}
        for node in given:
            if node not in children:
                self.add_node(node)

    @property
    def bg_color(self) -> Array:
        """The background, red, green, blue and opacity, 0 to 1, as the picture shows them."""
        return self._bg_color

    @bg_color.setter
    def bg_color(self, value: Any) -> None:
        self._bg_color = np.ones(4, np.float32) if value is None else _vector(value, 4, "bg_color")

    @property
    def ambient_light(self) -> Array:
        """Light from everywhere, linear."""
        return self._ambient_light

    @ambient_light.setter
    def ambient_light(self, value: Any) -> None:
        self._ambient_light = np.zeros(3, np.float32) if value is None else _vector(value, 3, "ambient_light")

    def add(self, obj: Mesh | Light | Camera, name: str | None = None, pose: Pose | None = None,
            parent_node: Node | None = None, parent_name: str | None = None) -> Node:
        """Adds a mesh, a light or a camera in a node of its own, which it returns."""
        if isinstance(obj, Mesh):
            node = Node(name=name, matrix=pose, mesh=obj)
        elif isinstance(obj, Light):
            node = Node(name=name, matrix=pose, light=obj)
        elif isinstance(obj, Camera):
            node = Node(name=name, matrix=pose, camera=obj)
        else:
            raise TypeError(f"obj: {type(obj).__name__}; expected a Mesh, a Light or a Camera of halfway.pyrender")
        if parent_node is None and parent_name is not None:
            found = self.get_nodes(name=parent_name)
            if len(found) != 1:
                raise ValueError(f"parent_name: {len(found)} nodes are named {parent_name!r}; expected one")
            parent_node = found.pop()
        self.add_node(node, parent_node)
        return node

    def add_node(self, node: Node, parent_node: Node | None = None) -> None:
        """Adds a node and its children."""
        if node in self._nodes:
            raise ValueError("node: it is in the scene already")
        if parent_node is not None:
            if parent_node not in self._nodes:
                raise ValueError("parent_node: it is not in the scene")
            if node not in parent_node.children:
                parent_node.children.append(node)
        node._parent = parent_node
        self._nodes[node] = None
        if node.camera is not None and self._main_camera_node is None:
            self._main_camera_node = node
        for child in node.children:
            self.add_node(child, node)

    def remove_node(self, node: Node) -> None:
        """Removes a node and its children."""
        self._expect(node)
        if node._parent is not None:
            node._parent.children.remove(node)
            node._parent = None
        self._drop(node)

    def _drop(self, node: Node) -> None:
        del self._nodes[node]
        for child in node.children:
            self._drop(child)
        if self._main_camera_node is node:
            self._main_camera_node = next((other for other in self._nodes if other.camera is not None), None)

    def _expect(self, node: Node) -> None:
        if node not in self._nodes:
            raise ValueError("node: it is not in the scene")

    def has_node(self, node: Node) -> bool:
        """Whether the node is in the scene."""
        return node in self._nodes

    def get_nodes(self, node: Node | None = None, name: str | None = None, obj: Any = None,
                  obj_name: str | None = None) -> set[Node]:
        """The nodes that meet all that is asked for."""
        def meets(other: Node) -> bool:
            objects = [each for each in (other.mesh, other.camera, other.light) if each is not None]
            return ((node is None or other is node) and (name is None or other.name == name)
                    and (obj is None or any(each is obj for each in objects))
                    and (obj_name is None or any(each.name == obj_name for each in objects)))

        return {other for other in self._nodes if meets(other)}

    def get_pose(self, node: Node) -> Array:
        """The matrix from the node to the world."""
        self._expect(node)
        pose, parent = node._matrix, node._parent
        while parent is not None:
            pose, parent = parent._matrix @ pose, parent._parent
        return pose.copy()

    def set_pose(self, node: Node, pose: Pose) -> None:
        """Moves a node: `pose` is the matrix to its parent."""
        self._expect(node)
        node._matrix = _checked(pose, "pose")

    def clear(self) -> None:
        """Removes all nodes."""
        self._nodes.clear()
        self._main_camera_node = None

    @property
    def main_camera_node(self) -> Node | None:
        """The node of the camera that draws."""
        return self._main_camera_node

    @main_camera_node.setter
    def main_camera_node(self, node: Node) -> None:
        self._expect(node)
        self._main_camera_node = node

    @property
    def nodes(self) -> set[Node]:
        """All nodes."""
        return set(self._nodes)

    @property
    def mesh_nodes(self) -> set[Node]:
        """The nodes with meshes."""
        return {node for node in self._nodes if node.mesh is not None}

    @property
    def light_nodes(self) -> set[Node]:
        """The nodes with lights."""
        return {node for node in self._nodes if node.light is not None}

    @property
    def camera_nodes(self) -> set[Node]:
        """The nodes with cameras."""
        return {node for node in self._nodes if node.camera is not None}

    @property
    def point_light_nodes(self) -> set[Node]:
        """The nodes with point lights."""
        return {node for node in self._nodes if isinstance(node.light, PointLight)}

    @property
    def spot_light_nodes(self) -> set[Node]:
        """The nodes with spot lights."""
        return {node for node in self._nodes if isinstance(node.light, SpotLight)}

    @property
    def directional_light_nodes(self) -> set[Node]:
        """The nodes with directional lights."""
        return {node for node in self._nodes if isinstance(node.light, DirectionalLight)}

    @property
    def meshes(self) -> set[Mesh]:
        """All meshes."""
        return {node.mesh for node in self._nodes if node.mesh is not None}

    @property
    def lights(self) -> set[Light]:
        """All lights."""
        return {node.light for node in self._nodes if node.light is not None}

    @property
    def cameras(self) -> set[Camera]:
        """All cameras."""
        return {node.camera for node in self._nodes if node.camera is not None}

    @property
    def bounds(self) -> Array:
        """The least and the greatest coordinates of the meshes, of shape (2, 3)."""
        corners = []
        for node in self._nodes:
            if node.mesh is not None:
                pose, ends = self.get_pose(node), node.mesh.bounds
                box = np.array([[ends[i, 0], ends[j, 1], ends[k, 2]] for i in (0, 1) for j in (0, 1) for k in (0, 1)])
                corners.append(box @ pose[:3, :3].T + pose[:3, 3])
        if not corners:
            return np.zeros((2, 3))
        points = np.concatenate(corners)
        return np.array([points.min(axis=0), points.max(axis=0)])

    @property
    def centroid(self) -> Array:
        """The middle of the bounds."""
        return np.asarray(self.bounds.mean(axis=0))

    @property
    def extents(self) -> Array:
        """The lengths of the bounds."""
        return np.asarray(self.bounds[1] - self.bounds[0])

    @property
    def scale(self) -> float:
        """The diagonal of the bounds."""
        return float(np.linalg.norm(self.extents))

    @staticmethod
    def from_trimesh_scene(trimesh_scene: Any, bg_color: Any = None, ambient_light: Any = None) -> Scene:
        """The meshes of a `trimesh.Scene`, where they stand."""
        made = {name: Mesh.from_trimesh(mesh) for name, mesh in trimesh_scene.geometry.items() if hasattr(mesh, "faces")}
        scene = Scene(bg_color=bg_color, ambient_light=ambient_light)
        for node in trimesh_scene.graph.nodes_geometry:
            pose, name = trimesh_scene.graph[node]
            if name in made:
                scene.add(made[name], pose=pose)
        return scene


class _Kept:
    """The scene of halfway made from one of these, kept while nothing but places changes."""

    def __init__(self, recipe: Any, scene: DrawnScene) -> None:
        self.recipe, self.scene, self.objects = recipe, scene, scene.objects
        self.poses: Array = np.zeros(0)
        self.camera: dict[str, Any] = {}
        self.lights: list[dict[str, Any]] = []


class OffscreenRenderer:
    """Draws pictures of this size. `point_size` has no effect, as there are no points."""

    def __init__(self, viewport_width: int, viewport_height: int, point_size: float = 1.0) -> None:
        self.viewport_width, self.viewport_height, self.point_size = int(viewport_width), int(viewport_height), point_size
        self._kept: weakref.WeakKeyDictionary[Scene, dict[int, _Kept]] = weakref.WeakKeyDictionary()
        self._images = _Images()

    def render(self, scene: Scene, flags: int = RenderFlags.NONE,
               seg_node_map: Mapping[Node, Any] | None = None) -> Any:
        """The colours (height, width, 3), or 4 with RGBA, of type uint8, and the depth (height, width), float32: lengths
        along the axis of the camera, 0 where nothing is. With DEPTH_ONLY it is the depth alone; with SEG the colours are
        those that `seg_node_map` has for nodes, and the others are left out."""
        node = scene.main_camera_node
        if node is None or node.camera is None:
            raise ValueError("scene: there is no camera in it; expected one, added by scene.add(camera, pose=...)")
        if flags & RenderFlags.SHADOWS_ALL:
            _warn_once("halfway.pyrender draws no shadows; the flags SHADOWS_DIRECTIONAL, SHADOWS_POINT and SHADOWS_SPOT "
                       "have no effect")
        if flags & RenderFlags.SEG and seg_node_map is None:
            raise ValueError("seg_node_map: expected a dictionary from nodes to colours beside the flag SEG")
        only_surfaces = bool(flags & (RenderFlags.DEPTH_ONLY | RenderFlags.SEG))
        owners, parts, poses = [], [], []
        for owner, part, pose in _parts(scene):
            if not flags & RenderFlags.SEG or owner in (seg_node_map or {}):
                owners.append(owner)
                parts.append(part)
                poses.append(pose)
        kept = self._scene(scene, node, flags, only_surfaces, parts, poses)
        outputs = ["depth"] + (["id"] if flags & RenderFlags.SEG else [] if only_surfaces else ["color"])
        with warnings.catch_warnings():
            # A picture of nothing is one that pyrender gives without a word.
            warnings.simplefilter("ignore", SceneWarning)
            drawn = kept.scene.render(size=(self.viewport_width, self.viewport_height), outputs=outputs)
        depth = np.array(drawn["depth"], np.float32)
        beyond = depth > node.camera.zfar if node.camera.zfar is not None else None
        if beyond is not None:
            depth[beyond] = 0
        if flags & RenderFlags.DEPTH_ONLY and not flags & RenderFlags.SEG:
            return depth
        background = np.round(np.clip(scene.bg_color, 0, 1) * 255).astype(np.uint8)
        if flags & RenderFlags.SEG:
            color = self._segments(np.asarray(drawn["id"]), owners, seg_node_map or {})
            background = np.array([0, 0, 0, 255], np.uint8)
        else:
            color = np.array(drawn["color"])
        if beyond is not None:
            color[beyond] = background
        if flags & RenderFlags.DEPTH_ONLY:
            return depth
        return (color if flags & RenderFlags.RGBA else np.ascontiguousarray(color[..., :3])), depth

    @staticmethod
    def _segments(ids: Array, owners: list[Node], colors: Mapping[Node, Any]) -> Array:
        table = np.zeros((len(owners) + 1, 4), np.uint8)
        table[:, 3] = 255
        for number, owner in enumerate(owners):
            table[number + 1, :3] = np.clip(np.round(np.broadcast_to(np.asarray(colors[owner], float), 3)), 0, 255)
        return np.asarray(table[ids])

    def _scene(self, scene: Scene, node: Node, flags: int, only_surfaces: bool, parts: list[Primitive],
               poses: list[Array]) -> _Kept:
        """The scene that halfway draws, made anew where more than places have changed."""
        assert node.camera is not None
        flat = bool(flags & RenderFlags.FLAT)
        camera = node.camera._keys(self.viewport_width, self.viewport_height) | placed_by(scene.get_pose(node))
        lights = [] if flat or only_surfaces else [other.light._keys(scene.get_pose(other)) for other in scene._nodes
                                                   if other.light is not None]
        meshes = [part._drawn(flat) for part in parts]
        keys = [part._keys(flags, only_surfaces, self._images) for part in parts]
        recipe = ([id(mesh) for mesh in meshes], keys, scene.bg_color.tolist(), scene.ambient_light.tolist(),
                  [light["kind"] for light in lights], set(camera))
        stacked = np.array(poses, np.float32).reshape(-1, 4, 4)
        of_flags = self._kept.setdefault(scene, {})
        kept = of_flags.get(flags)
        if kept is None or kept.recipe != recipe:
            drawn = DrawnScene({
                "background": _decoded(np.clip(scene.bg_color[:3], 0, 1)).tolist(),
                "background_opacity": float(np.clip(scene.bg_color[3], 0, 1)),
                "ambient": [1.0] * 3 if flat else scene.ambient_light.tolist(),
                "shading": "unlit" if flat else "phong", "samples": 1 if only_surfaces else 4,
                "camera": camera, "lights": lights, "objects": [],
            })
            for mesh, of_object, pose in zip(meshes, keys, stacked):
                drawn.add(mesh, pose=pose, **of_object)
            kept = of_flags[flags] = _Kept(recipe, drawn)
        else:
            if kept.camera != camera:
                kept.scene.camera.set(**camera)
            for light, old, new in zip(kept.scene.lights, kept.lights, lights):
                if old != new:
                    light.set(**new)
            moved = np.flatnonzero((kept.poses != stacked).any(axis=(1, 2)))
            if len(moved):
                kept.scene.place([kept.objects[i] for i in moved], stacked[moved])
        kept.poses, kept.camera, kept.lights = stacked, camera, lights
        return kept

    def delete(self) -> None:
        """Frees what is kept of the scenes that were drawn."""
        self._kept.clear()
        self._images.clear()

    def __del__(self) -> None:
        # Where the size was wrong, there is nothing to free.
        if hasattr(self, "_images"):
            self.delete()


def _parts(scene: Scene) -> Iterator[tuple[Node, Primitive, Array]]:
    """All that is drawn, with its node and its place."""
    for node in scene._nodes:
        if node.mesh is None or not node.mesh.is_visible:
            continue
        pose = scene.get_pose(node)
        for primitive in node.mesh.primitives:
            for own in [None] if primitive.poses is None else primitive.poses:
                yield node, primitive, pose if own is None else pose @ own


class Viewer:
    """A window cannot be opened here: an error says so."""

    def __init__(self, *_: Any, **__: Any) -> None:
        raise NotImplementedError("Viewer: halfway.pyrender draws into arrays; expected OffscreenRenderer, or the command "
                                  "`halfway view` for a window")
