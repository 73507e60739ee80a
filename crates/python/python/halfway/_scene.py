"""Scenes: cameras, lights and objects that are composed, moved and drawn."""

from __future__ import annotations

import json
import operator
import os
import warnings
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, Unpack, overload

import numpy as np
import numpy.typing as npt

from . import _halfway
from ._arguments import COLOR_OPTIONS, Color, Options, as_json, color_text, linear, matrix, numbers, option_texts, size_of
from ._explain import Explanation, Report
from ._mesh import Mesh, Placed, placed
from ._parts import COLORS, placed_by
from ._picture import Comparison, Picture, as_picture, from_pixels, save_animation

Outputs = dict[str, npt.NDArray[Any]]


class SceneWarning(UserWarning):
    """Something of a scene or of a model that is not shown as it was meant."""


class Entry:
    """A camera, a light or an object of a scene: its keys are those that scene files have, read and set by name."""

    _kind = ""

    def __init__(self, scene: Scene, data: dict[str, Any]) -> None:
        self._scene, self._data = scene, data

    def get(self, key: str) -> Any:
        """The value of a key, `None` where it was not given."""
        return self._data.get(key)

    def set(self, **keys: Any) -> None:
        """Sets keys, such as `shading="flat"`, checked; `None` takes one away."""
        changed = dict(self._data)
        for key, value in keys.items():
            if value is None:
                changed.pop(key, None)
            else:
                changed[key] = linear(value, key) if key in COLORS else value
        _halfway.check(self._kind, as_json(changed), self._label())
        if changed.get("name") != self._data.get("name"):
            self._scene._expect_new_name(changed.get("name"))
        self._data.clear()
        self._data.update(changed)
        self._changed()

    def _label(self) -> str:
        return repr(self._data["name"]) if "name" in self._data else self._kind

    def _changed(self) -> None:
        self._scene._forget()

    @property
    def name(self) -> str | None:
        """Its name, by which the scene finds it."""
        return self._data.get("name")

    def __repr__(self) -> str:
        return f"<halfway {self._kind} {self._data.get('name', '')!r}>"


class SceneObject(Entry):
    """An object of a scene."""

    _kind = "object"

    @property
    def pose(self) -> npt.NDArray[np.float64]:
        """The matrix of 4 by 4 that takes it into the world."""
        given = self._data.get("transform", {})
        if "matrix" in given:
            return np.array(given["matrix"], np.float64).reshape(4, 4).T
        return _of_parts(given)

    @pose.setter
    def pose(self, pose: npt.ArrayLike) -> None:
        self._scene.place([self], [pose])

    @property
    def position(self) -> npt.NDArray[np.float64]:
        """Where it stands."""
        return self.pose[:3, 3]

    @position.setter
    def position(self, position: Any) -> None:
        pose = self.pose.copy()
        pose[:3, 3] = numbers(position, "position", 3)
        self.pose = pose


class SceneLight(Entry):
    """A light of a scene."""

    _kind = "light"

    @property
    def position(self) -> npt.NDArray[np.float64]:
        """Where it is."""
        return np.array(self._data.get("position", (2, 0, 2)), np.float64)

    @position.setter
    def position(self, position: Any) -> None:
        self.set(position=numbers(position, "position", 3))

    @property
    def direction(self) -> npt.NDArray[np.float64]:
        """The way its light travels."""
        return np.array(self._data.get("direction", (0, -1, 0)), np.float64)

    @direction.setter
    def direction(self, direction: Any) -> None:
        self.set(direction=numbers(direction, "direction", 3))

    def _changed(self) -> None:
        number = next(i for i, data in enumerate(self._scene._data["lights"]) if data is self._data)
        text = as_json(self._data)
        self._scene._move_or_forget(lambda drawing: drawing.place_light(number, text))


class SceneCamera(Entry):
    """A camera of a scene."""

    _kind = "camera"

    @property
    def position(self) -> npt.NDArray[np.float64]:
        """Where it stands."""
        return np.array(self._data.get("position", (0, 0, 3)), np.float64)

    @position.setter
    def position(self, position: Any) -> None:
        self.set(view=None, position=numbers(position, "position", 3))

    @property
    def target(self) -> npt.NDArray[np.float64]:
        """The point that it looks at."""
        return np.array(self._data.get("target", (0, 0, 0)), np.float64)

    @target.setter
    def target(self, target: Any) -> None:
        self.set(view=None, target=numbers(target, "target", 3))

    def place(self, pose: npt.ArrayLike) -> None:
        """Moves it by a matrix of 4 by 4 from the camera to the world."""
        self.set(view=None, **placed_by(pose))

    def _changed(self) -> None:
        if self._scene._data.get("camera") is self._data and not self._scene._data.get("cameras"):
            text = as_json(self._data)
            self._scene._move_or_forget(lambda drawing: drawing.place_camera(text))
        else:
            self._scene._forget()


def _of_parts(given: Mapping[str, Any]) -> npt.NDArray[np.float64]:
    x, y, z, w = given.get("rotation", (0, 0, 0, 1))
    turn = np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ])
    pose = np.eye(4)
    pose[:3, :3] = turn * np.array(given.get("scale", (1, 1, 1)))
    pose[:3, 3] = given.get("translation", (0, 0, 0))
    return pose


class Scene:
    """A scene that is composed, changed and drawn.

    `Scene()` is empty: a camera that frames what is added, lit by the studio's lights, before charcoal. `Scene("a.json")`
    is a scene file; `Scene({...})` its contents, with the same keys. Anything else is taken as meshes.

        scene = halfway.Scene()
        ball = scene.add({"uv_sphere": {}}, name="ball", material="brass")
        scene.add_light(halfway.PointLight(name="lamp", position=(2, 3, 2)))
        scene["lamp"].position = (0, 3, 2)
        picture = scene.render(size=(640, 480))
    """

    def __init__(self, source: Any = None, *, base_dir: str | os.PathLike[str] | None = None) -> None:
        self._meshes: list[Mesh] = []
        self._drawings: dict[Any, Any] = {}
        self._origin = "scene"
        self._base_dir = "" if base_dir is None else os.fspath(base_dir)
        self._is_ours = False
        if isinstance(source, (str, os.PathLike)) and os.fspath(source).lower().endswith(".json"):
            self._origin = os.fspath(source)
            self._base_dir = os.path.dirname(self._origin) if base_dir is None else self._base_dir
            with open(source, encoding="utf-8-sig") as file:
                text = file.read()
            self._warn(_halfway.check("scene", text, self._origin))
            self._data: dict[str, Any] = json.loads(text)
        elif isinstance(source, Mapping):
            self._data = json.loads(as_json(source))
            self._warn(_halfway.check("scene", as_json(self._data), self._origin))
        else:
            self._data = json.loads(_halfway.default_scene())
            self._is_ours = True
            if source is not None:
                self.add(source)
        self._data.setdefault("objects", [])

    # Its contents.

    def add(
        self,
        mesh: Any,
        triangles: npt.ArrayLike | None = None,
        /,
        *,
        name: str | None = None,
        pose: npt.ArrayLike | None = None,
        color: Color | None = None,
        **keys: Any,
    ) -> SceneObject:
        """Adds an object: arrays, a path, a mesh of this or another package, or a surface by its key, such as
        `{"teapot": {"divisions": 8}}`. `keys` are those of objects in scene files: material, shading, faces, layers,
        edges, maps and so on. Of meshes that come with several parts it returns the first."""
        if color is not None:
            from ._parts import Material

            keys["material"] = Material(color=color)
        if isinstance(mesh, Mapping):
            parts = [Placed(mesh, None, {})]  # type: ignore[arg-type]
        else:
            parts = placed(mesh, triangles)
        if not parts:
            raise ValueError("mesh: there are no meshes in it")
        added = []
        for number, part in enumerate(parts):
            data: dict[str, Any] = {"mesh": part.mesh if isinstance(part.mesh, Mapping) else self._attach(part.mesh)}
            if isinstance(part.mesh, Mesh):
                data["normals"] = "auto"
            data |= part.keys | {key: value for key, value in keys.items() if value is not None}
            if name is not None:
                data["name"] = name if number == 0 else f"{name}.{number}"
                self._expect_new_name(data["name"])
            place = part.pose if pose is None else matrix(pose, "pose") @ (np.eye(4) if part.pose is None else part.pose)
            if place is not None:
                data["transform"] = {"matrix": matrix(place, "pose").T.reshape(-1)}
            _halfway.check("object", as_json(data), name or "object")
            added.append(data)
        self._data["objects"].extend(added)
        self._forget()
        return SceneObject(self, added[0])

    def add_light(self, light: Mapping[str, Any]) -> SceneLight:
        """Adds a light, in place of the studio's where those were not asked for."""
        data = dict(light)
        _halfway.check("light", as_json(data), data.get("name", "light"))
        self._expect_new_name(data.get("name"))
        if not isinstance(self._data.get("lights"), list):
            self._data["lights"] = []
        self._data["lights"].append(data)
        self._forget()
        return SceneLight(self, data)

    def add_camera(self, camera: Mapping[str, Any]) -> SceneCamera:
        """Adds a further camera, by its name or its number an argument of `render`."""
        data = self._checked_camera(camera)
        self._expect_new_name(data.get("name"))
        self._data.setdefault("cameras", []).append(data)
        self._forget()
        return SceneCamera(self, data)

    def _checked_camera(self, camera: Mapping[str, Any]) -> dict[str, Any]:
        data = dict(camera)
        tried = _with_size(data, (640, 480))
        _halfway.check("camera", as_json(tried), data.get("name", "camera"))
        return data

    def remove(self, entry: Entry | str) -> None:
        """Takes a camera, a light or an object away."""
        entry = self[entry] if isinstance(entry, str) else entry
        for key in ("objects", "lights", "cameras"):
            kept = self._data.get(key)
            if isinstance(kept, list):
                self._data[key] = [data for data in kept if data is not entry._data]
        if self._data.get("camera") is entry._data:
            del self._data["camera"]
        self._forget()

    @property
    def objects(self) -> list[SceneObject]:
        """Its objects."""
        return [SceneObject(self, data) for data in self._data["objects"]]

    @property
    def lights(self) -> list[SceneLight]:
        """The lights that it lists; none where it has a rig, or those of its models."""
        lights = self._data.get("lights")
        return [SceneLight(self, data) for data in lights] if isinstance(lights, list) else []

    @property
    def camera(self) -> SceneCamera:
        """The camera that draws unless another is asked for. Assigning keys of a camera replaces it."""
        if not isinstance(self._data.get("camera"), dict):
            self._data["camera"] = json.loads(_halfway.default_scene())["camera"]
        return SceneCamera(self, self._data["camera"])

    @camera.setter
    def camera(self, camera: Mapping[str, Any]) -> None:
        self._data["camera"] = self._checked_camera(camera)
        self._forget()

    def _entries(self) -> Iterator[Entry]:
        yield from self.objects
        yield from self.lights
        cameras = [self._data.get("camera"), *self._data.get("cameras", [])]
        yield from (SceneCamera(self, data) for data in cameras if isinstance(data, dict))

    def __getitem__(self, name: str) -> Any:
        for entry in self._entries():
            if entry.name == name:
                return entry
        known = ", ".join(repr(entry.name) for entry in self._entries() if entry.name) or "none has a name"
        raise KeyError(f"no object, light or camera is named {name!r}; there are {known}")

    def _expect_new_name(self, name: str | None) -> None:
        if name is not None and any(entry.name == name for entry in self._entries()):
            raise ValueError(f"name: {name!r} is taken; expected one that no other object, light or camera has")

    def get(self, key: str) -> Any:
        """The value of a key of the scene, such as `background`; `None` where it was not given."""
        return self._data.get(key)

    def set(self, **keys: Any) -> None:
        """Sets keys of the scene, as scene files have them: background, ambient, environment, shading, viewer …"""
        for key in ("ambient", "background", "background_below"):
            if isinstance(keys.get(key), str):
                keys[key] = linear(keys[key], key)
        changed = self._data | keys
        _halfway.check("scene", as_json(changed), self._origin)
        self._data = changed
        self._forget()

    def place(self, objects: Sequence[SceneObject], poses: Sequence[npt.ArrayLike] | npt.NDArray[Any]) -> None:
        """Moves objects, each to where its matrix of 4 by 4 takes it: the fastest way to move many."""
        given = np.asarray(poses, np.float64)
        if given.shape != (len(objects), 4, 4):
            raise ValueError(f"poses: shape {given.shape}; expected ({len(objects)}, 4, 4)")
        if not np.isfinite(given).all():
            raise ValueError("poses: hold numbers that are not finite")
        given = np.ascontiguousarray(given)
        places = {id(data): number for number, data in enumerate(self._data["objects"])}
        found = np.array([places[id(entry._data)] for entry in objects], np.uint32)
        for entry, pose in zip(objects, given):
            entry._data["transform"] = {"matrix": pose.T.reshape(-1)}
        self._move_or_forget(lambda drawing: drawing.place_objects(found, given))

    def save(self, file: str | os.PathLike[str]) -> None:
        """Writes a scene file. Meshes that are in memory only cannot be written."""
        if self._meshes:
            raise ValueError(f"scene: {len(self._meshes)} of its meshes are arrays in memory; expected paths or surfaces, "
                             "which a scene file can name")
        with open(file, "w", encoding="utf-8") as out:
            out.write(json.dumps(json.loads(as_json(self._data)), indent=2) + "\n")

    # How it is drawn.

    def _attach(self, mesh: Mesh) -> dict[str, str]:
        for number, known in enumerate(self._meshes):
            if known is mesh:
                return {"path": f"{number}.mesh.obj"}
        self._meshes.append(mesh)
        if self._is_ours and self._data.get("lights") == "studio" and mesh._mesh.has_lights():
            self._data["lights"] = None
        return {"path": f"{len(self._meshes) - 1}.mesh.obj"}

    def _forget(self) -> None:
        self._drawings.clear()

    def _move_or_forget(self, move: Any) -> None:
        if not all(move(drawing) for drawing in self._drawings.values()):
            self._forget()

    def _warn(self, said: Sequence[str]) -> None:
        for sentence in said:
            warnings.warn(sentence, SceneWarning, stacklevel=4)

    def _drawing(
        self, size: object, camera: str | int | Mapping[str, Any] | None, options: Mapping[str, Any], reference: bool
    ) -> tuple[Any, bool]:
        """The drawing of this size and these options, and whether it is a new one."""
        texts = option_texts({key: color_text(value, key) if key in COLOR_OPTIONS else value
                              for key, value in options.items()})
        pixels = size_of(size if size is not None else self._data.get("size", (1280, 720)))
        given = None if camera is None or isinstance(camera, Mapping) else str(camera)
        key = (pixels, given, tuple(texts), reference, as_json(camera) if isinstance(camera, Mapping) else None)
        if key in self._drawings:
            return self._drawings[key], False
        data = self._data
        if isinstance(camera, Mapping):
            data = {k: v for k, v in data.items() if k != "cameras"} | {"camera": dict(camera)}
        seen = {k: _with_size(v, pixels) if k == "camera" and v else v for k, v in data.items()}
        if data.get("cameras"):
            seen["cameras"] = [_with_size(other, pixels) for other in data["cameras"]]
        meshes = [mesh._mesh for mesh in self._meshes]
        drawing = _halfway.Drawing(as_json(seen), self._origin, self._base_dir, meshes, texts, list(pixels), given,
                                   reference)
        # The newest are kept: views that alternate are drawn from what is there.
        while len(self._drawings) >= 4:
            # Another thread may have taken it out.
            self._drawings.pop(next(iter(self._drawings), None), None)
        self._drawings[key] = drawing
        return drawing, True

    @overload
    def render(self, *, size: object = ..., camera: Any = ..., time: float = ..., floats: bool = ...,
               outputs: None = ..., **options: Unpack[Options]) -> Picture: ...

    @overload
    def render(self, *, size: object = ..., camera: Any = ..., time: float = ..., floats: bool = ...,
               outputs: Sequence[str], **options: Unpack[Options]) -> Outputs: ...

    def render(self, *, size: object = None, camera: Any = None, time: float = 0.0, floats: bool = False,
               outputs: Sequence[str] | None = None, **options: Unpack[Options]) -> Picture | Outputs:
        """Draws a picture of `size` pixels, (width, height), at `time` seconds of the scene's animation: of bytes, or,
        with `floats`, of linear intensities.

        `camera` is a `Camera`, or the name or number of one of the scene's. With `outputs` the result is a dictionary of
        arrays: "color", and any of `halfway.OUTPUTS`, such as "depth" (world units along the axis of the camera) or "id"
        (the number of the object, from 1 on); all are 0 where there is only background. "ambient", "diffuse", "specular"
        and "emission" are what one term of the light adds, in linear intensities. `options` are those of the command,
        with the same values: view, up, ortho, shading, background, edges and so on.
        """
        return self._draw(size, camera, time, floats, outputs, options, reference=False)

    @overload
    def reference(self, *, size: object = ..., camera: Any = ..., time: float = ..., floats: bool = ...,
                  outputs: None = ..., **options: Unpack[Options]) -> Picture: ...

    @overload
    def reference(self, *, size: object = ..., camera: Any = ..., time: float = ..., floats: bool = ...,
                  outputs: Sequence[str], **options: Unpack[Options]) -> Outputs: ...

    def reference(self, *, size: object = None, camera: Any = None, time: float = 0.0, floats: bool = False,
                  outputs: Sequence[str] | None = None, **options: Unpack[Options]) -> Picture | Outputs:
        """Draws as `render` does, by the reference renderer: every pixel in 64-bit arithmetic, slowly."""
        return self._draw(size, camera, time, floats, outputs, options, reference=True)

    def _draw(self, size: object, camera: Any, time: float, floats: bool, outputs: Sequence[str] | None,
              options: Any, reference: bool) -> Picture | Outputs:
        (at,) = numbers([time], "time", 1)
        if isinstance(outputs, str):
            raise TypeError(f"outputs: {outputs!r}; expected a list, such as [{outputs!r}]")
        drawing, is_new = self._drawing(size, camera, options, reference)
        wanted = [name for name in outputs or () if name != "color"]
        pixels, images, why = drawing.draw(at, bool(floats), wanted, is_new)
        if is_new:
            self._warn(drawing.take_warnings())
            if why:
                self._warn([f"the picture shows nothing: {why}"])
        picture = from_pixels(*pixels)
        picture.encoding = self._data.get("output", "srgb")
        if outputs is None:
            return picture
        arrays = {name: _quantity(picture.shape, *images[name]) for name in wanted}
        return {name: picture if name == "color" else arrays[name] for name in outputs}

    def sheet(self, views: Sequence[str] | str, *, size: object = (400, 300), **options: Unpack[Options]) -> Picture:
        """Several views on one sheet with captions, each of `size` pixels; with `ortho=True` at one scale."""
        text = views if isinstance(views, str) else ",".join(views)
        if "view" in options:
            raise TypeError("view: cannot stand beside views")
        drawing, is_new = self._drawing(size, None, {"fit": 0.9, **options}, False)
        # Its camera is moved from view to view.
        self._drawings = {key: value for key, value in list(self._drawings.items()) if value is not drawing}
        sheet = drawing.sheet(text)
        if is_new:
            self._warn(drawing.take_warnings())
        return from_pixels(*sheet)

    def turntable(self, frames: int = 36, *, size: object = None, **options: Unpack[Options]) -> list[Picture]:
        """Pictures of a camera that turns once around the upright axis."""
        _expect_frames(frames)
        drawing, _ = self._drawing(size, None, options, False)
        self._forget()
        drawing.turn(frames)
        return [from_pixels(*drawing.draw(0.0, False, [], False)[0]) for _ in range(frames)]

    def animate(self, file: str | os.PathLike[str], frames: int | None = None, *, fps: int = 30, size: object = None,
                camera: Any = None, **options: Unpack[Options]) -> None:
        """Writes the scene's animation, or, where it has none, a turn of the camera, as an animated PNG of so many
        frames, frame f at f / fps seconds."""
        count = 36 if frames is None else frames
        _expect_frames(count)
        if any(entry.get("animation") for entry in self._entries()):
            pictures = [self.render(size=size, camera=camera, time=f / fps, **options) for f in range(count)]
        else:
            pictures = self.turntable(count, size=size, **options)
        save_animation(file, pictures, fps)

    def verify(self, picture: Any, *, camera: Any = None, max: int = 1, **options: Unpack[Options]) -> dict[str, Any]:
        """Judges a picture of this scene, of whatever renderer, by the reference renderer: no pixel may differ by more
        than `max` steps of 1/255 from every colour that it may show. The size is the picture's."""
        given = as_picture(picture)
        drawing, _ = self._drawing(given._size, camera, options, False)
        judged: dict[str, Any] = drawing.judge(np.ascontiguousarray(np.asarray(given)), given._size, float(max))
        return judged

    def mark(self, picture: Any, *, rubric: Any = None, camera: Any = None, max: int = 1,
             **options: Unpack[Options]) -> Report:
        """Marks a picture of this scene that somebody has drawn: whether it is right, its points, and which mistakes
        explain the difference. `rubric` is a file or a dictionary with the keys of `halfway mark --rubric`; the other
        arguments are those of `verify`. It is marked without lines along edges, before an opaque background of one
        colour."""
        given = as_picture(picture)
        drawing, _ = self._drawing(given._size, camera, options, False)
        values, text = drawing.mark(np.ascontiguousarray(np.asarray(given)), given._size, float(max), _rubric(rubric))
        return Report(json.loads(values), text)

    def explain(self, at: Sequence[int], *, size: object = None, camera: Any = None, time: float = 0.0,
                **options: Unpack[Options]) -> Explanation:
        """Explains the pixel in column and row `at`, counted from 0 from the top left, of a picture of `size` pixels: its
        surfaces, every light and term there, their sum, and its encoding, as the reference renderer computes them. The
        other arguments are those of `render`."""
        try:
            x, y = (operator.index(place) for place in at)
        except (TypeError, ValueError):
            raise TypeError(f"at: {at!r}; expected (column, row), two whole numbers") from None
        if x < 0 or y < 0:
            raise ValueError(f"at: {(x, y)}; expected a column and a row of the picture, 0 or more")
        (moment,) = numbers([time], "time", 1)
        drawing, is_new = self._drawing(size, camera, options, True)
        values, text, latex = drawing.explain(x, y, moment)
        if is_new:
            self._warn(drawing.take_warnings())
        return Explanation(json.loads(values), text, latex)

    def compare(self, picture: Any, **options: Any) -> Comparison:
        """Compares a picture with the reference renderer's."""
        given = as_picture(picture)
        return given.diff(self.reference(size=given._size, floats=given.dtype != np.uint8, **options))

    def _repr_png_(self) -> bytes:
        return self.render(size=(640, 480)).png()


def _expect_frames(frames: int) -> None:
    if not isinstance(frames, int) or not 1 <= frames <= 100_000:
        raise ValueError(f"frames: {frames!r}; expected 1 to 100000")


def _rubric(rubric: Any) -> str:
    """A rubric as JSON."""
    if rubric is None:
        return "{}"
    if isinstance(rubric, Mapping):
        return as_json(dict(rubric))
    return Path(rubric).read_text(encoding="utf-8")


def _with_size(camera: Mapping[str, Any], size: tuple[int, int]) -> dict[str, Any]:
    """The camera with intrinsics of this size where none was given."""
    data = dict(camera)
    if isinstance(data.get("intrinsics"), Mapping) and "size" not in data["intrinsics"]:
        data["intrinsics"] = data["intrinsics"] | {"size": list(size)}
    return data


def _quantity(shape: tuple[int, ...], is_float: bool, channels: int, numbers: bytearray) -> npt.NDArray[Any]:
    array = np.frombuffer(numbers, np.float32 if is_float else np.uint32)
    return array.reshape(shape[:2] if channels == 1 else (*shape[:2], channels))

