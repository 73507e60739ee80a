"""Arguments, checked and turned into those of the compiled half."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Sequence
from typing import Any, TypeAlias, TypedDict

import numpy as np
import numpy.typing as npt

from . import _halfway

Floats: TypeAlias = npt.NDArray[np.float32]
Indices: TypeAlias = npt.NDArray[np.uint32]
Vector: TypeAlias = Sequence[float] | npt.NDArray[Any]
Color: TypeAlias = str | Vector


class Options(TypedDict, total=False):
    """The options of drawing, with the names and the values that the command has."""

    view: str | tuple[float, float]
    up: str
    ortho: bool
    fit: float
    zoom: float
    color: Color
    faces: str
    normals: str
    mark_missing_images: bool
    background: Color
    lights: str
    shading: str
    reflectance: str
    only: str
    light: str | int
    samples: int
    intensity: str
    tolerance: str | float | tuple[float, float]
    edges: str
    edge_width: float | str
    hidden_edges: bool
    wireframe: bool
    scalars: str
    map: str
    range: tuple[float, float]
    isolines: int
    legend: str
    line_width: float | str
    point_size: float | str
    hidden_lines: bool
    show: str | Sequence[str]
    animation: str | int


def size_of(size: object) -> tuple[int, int]:
    """Width and height in pixels."""
    if isinstance(size, int) and not isinstance(size, bool):
        size = (size, size)
    if isinstance(size, str) and size.count("x") == 1:
        size = tuple(size.split("x"))
    try:
        width, height = (int(side) for side in size)  # type: ignore[attr-defined]
    except (TypeError, ValueError):
        raise TypeError(f"size: {size!r}; expected (width, height) in pixels, such as (800, 600)") from None
    if not (1 <= width <= 16384 and 1 <= height <= 16384):
        raise ValueError(f"size: {width} x {height}; expected 1 to 16384 pixels each")
    return width, height


def floats(values: object, name: str, columns: int | None) -> Floats:
    """A contiguous array of finite or other floats, of rows of `columns`, or flat."""
    expected = f"(n, {columns})" if columns else "(n,)"
    try:
        array = np.asarray(values)
        if array.dtype.kind not in "fiub":
            raise TypeError(f"numbers of type {array.dtype}")
        array = np.ascontiguousarray(array, dtype=np.float32)
    except (TypeError, ValueError) as error:
        raise TypeError(f"{name}: {error}; expected an array of numbers of shape {expected}") from None
    if array.size == 0 and columns:
        array = array.reshape(0, columns)
    if array.ndim != (2 if columns else 1) or (columns and array.shape[1] != columns):
        raise ValueError(f"{name}: shape {array.shape}; expected {expected}")
    return array


def counted(vertices: object, name: str) -> tuple[Floats, list[float]]:
    """Vertices as floats, and the point that they are counted from: 0 unless they are far away beside their size."""
    try:
        array = np.asarray(vertices)
    except ValueError:
        array = np.zeros(0)
    far = array.dtype.kind in "fiu" and array.dtype.itemsize > 4 and array.ndim == 2 and array.shape[1:] == (3,) and array.size
    origin = list(_halfway.origin_of_box(array.min(axis=0).tolist(), array.max(axis=0).tolist())) if far else [0.0] * 3
    return floats(array - origin if any(origin) else vertices, name, 3), origin


def triangles(faces: object, vertices: int) -> tuple[Indices, npt.NDArray[np.intp] | None]:
    """Triangles as indices, and, where quadrilaterals were cut in two, the number of the face that each belongs to."""
    try:
        array = np.asarray(faces)
    except ValueError:
        raise ValueError("faces: rows of different lengths; expected three or four indices each") from None
    if array.dtype.kind not in "iu" and array.size:
        raise TypeError(f"faces: numbers of type {array.dtype}; expected whole numbers, the indices of vertices")
    if array.ndim != 2 or array.shape[1] not in (3, 4):
        raise ValueError(f"faces: shape {array.shape}; expected (n, 3), or (n, 4) for quadrilaterals")
    if array.size == 0:
        raise ValueError("faces: there are none; expected at least one")
    low, high = int(array.min()), int(array.max())
    if low < 0 or high >= vertices:
        wrong = low if low < 0 else high
        row = int(np.argwhere(array == wrong)[0][0])
        raise ValueError(f"faces[{row}]: index {wrong}; expected 0 to {vertices - 1}, as there are {vertices} vertices")
    of_face = None
    if array.shape[1] == 4:
        of_face = np.repeat(np.arange(len(array)), 2)
        array = array[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)
    return np.ascontiguousarray(array, dtype=np.uint32), of_face


def numbers(values: object, name: str, count: int) -> list[float]:
    """So many finite numbers."""
    try:
        found = [float(value) for value in values]  # type: ignore[attr-defined]
    except (TypeError, ValueError):
        raise TypeError(f"{name}: {values!r}; expected {count} numbers") from None
    if len(found) != count or not all(math.isfinite(value) for value in found):
        raise ValueError(f"{name}: {values!r}; expected {count} finite numbers")
    return found


def linear(color: object, name: str) -> list[float]:
    """A colour as linear red, green and blue: text as CSS has it, or the three numbers themselves."""
    if isinstance(color, str):
        try:
            return list(_halfway.css(color)[:3])
        except ValueError as error:
            raise ValueError(f"{name}: {error}") from None
    return numbers(color, name, 3)


COLOR_OPTIONS = ("color", "background")


def color_text(color: object, name: str) -> object:
    """Linear numbers as text that CSS has, so that it comes back to them; text as it is."""
    if color is None or isinstance(color, str):
        return color
    encoded = [_halfway.srgb(value) * 100 for value in numbers(color, name, 3)]
    return "rgb({:.7f}% {:.7f}% {:.7f}%)".format(*encoded)


def matrix(pose: object, name: str) -> npt.NDArray[np.float64]:
    """A matrix of 4 by 4 that moves, turns and scales."""
    try:
        array = np.array(pose, dtype=np.float64)
    except (TypeError, ValueError):
        raise TypeError(f"{name}: expected a matrix of shape (4, 4)") from None
    if array.shape != (4, 4):
        raise ValueError(f"{name}: shape {array.shape}; expected a matrix of shape (4, 4)")
    if not np.isfinite(array).all():
        raise ValueError(f"{name}: holds numbers that are not finite")
    if not np.allclose(array[3], (0, 0, 0, 1), atol=1e-6):
        raise ValueError(f"{name}: the last row is {array[3].tolist()}; expected [0, 0, 0, 1]")
    array = np.ascontiguousarray(array)
    array[3] = (0, 0, 0, 1)
    return array


def _text(value: object) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return value
    if isinstance(value, (int, float, np.integer, np.floating)):
        return repr(value.item() if isinstance(value, np.generic) else value)
    if isinstance(value, Iterable):
        return ",".join(_text(item) for item in value)
    raise TypeError(f"{value!r} of type {type(value).__name__}")


def option_texts(options: dict[str, Any]) -> list[tuple[str, str]]:
    """Options as the command has them, each checked. Colours of numbers are not among them."""
    texts = []
    for name, value in options.items():
        if name not in _halfway.OPTIONS:
            known = ", ".join(_halfway.OPTIONS)
            raise TypeError(f"unknown argument {name!r}; expected one of {known}")
        if value is None:
            continue
        try:
            text = ("..".join(_text(end) for end in value) if name == "range" and not isinstance(value, str)
                    else _text(value))
        except TypeError as error:
            raise TypeError(f"{name}: {error}; expected text or a number") from None
        texts.append((name, text))
    _halfway.check_options(texts)
    return texts


def as_json(value: object) -> str:
    """JSON, with arrays as lists and tuples as lists."""

    def other(value: object) -> object:
        if isinstance(value, np.ndarray):
            return value.tolist()
        if isinstance(value, np.generic):
            return value.item()
        raise TypeError(f"{value!r} of type {type(value).__name__} has no place in a scene")

    return json.dumps(value, default=other, allow_nan=False)
