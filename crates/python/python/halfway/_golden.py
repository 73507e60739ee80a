"""Pictures in tests: compared with stored ones, and shown beside them where they differ."""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from ._picture import Comparison, Picture, as_picture, compare, open_picture

FAILURES = "halfway-pictures"
GAP = 8


def check(
    picture: Any,
    golden: str | os.PathLike[str],
    *,
    max_steps: int = 0,
    equal: float | None = None,
    folder: str | os.PathLike[str] = FAILURES,
    update: bool = False,
) -> None:
    """Asserts that a picture is the one that the file `golden` stores.

    By default all bytes are the same. With `max_steps` channels may differ by so many steps of 1/255, 0 to 255. `equal`
    is the share of pixels, 0 to 1, that has to be the same to the byte, however much the others differ; beside
    `max_steps`, both have to hold. With `update` the picture is stored in place of a comparison; a picture that is the
    same already leaves the file as it is.

    Where they differ, the `AssertionError` holds the figures of the comparison, and `folder` gets NAME-actual.png,
    NAME-expected.png, NAME-difference.png, and NAME.png with the three beside each other.

        halfway.check(halfway.render(mesh), "tests/pictures/mesh.png")
    """
    __tracebackhide__ = True
    if not isinstance(max_steps, int) or not 0 <= max_steps <= 255:
        raise ValueError(f"max_steps: {max_steps!r}; expected 0 to 255")
    if equal is not None and not 0.0 <= equal <= 1.0:
        raise ValueError(f"equal: {equal!r}; expected a share of the pixels, 0 to 1")
    file = Path(golden)
    if file.suffix.lower() != ".png":
        raise ValueError(f"golden: {os.fspath(golden)!r}; expected a file that ends in .png")
    actual = as_picture(picture)
    if actual.dtype != np.uint8:
        raise TypeError(f"picture: numbers of type {actual.dtype}; expected uint8, as a PNG has them")
    if update:
        if not (file.exists() and _is_same(actual, open_picture(file))):
            file.parent.mkdir(parents=True, exist_ok=True)
            actual.save(file)
        return
    if not file.exists():
        written = _write(Path(folder), _name(file), {"actual": actual})
        raise AssertionError(f"{file}: there is no such golden picture. The picture is in {written['actual']}: look at it, "
                             f"and where it is right, copy it there, or call halfway.check with update=True (pytest: "
                             "--update-pictures)")
    expected = open_picture(file)
    if actual.shape != expected.shape:
        both: dict[str, npt.NDArray[Any]] = {"actual": actual, "expected": expected}
        written = _write(Path(folder), _name(file), both)
        raise AssertionError(f"{file}: the picture has {_size(actual)} pixels; expected {_size(expected)}; see "
                             f"{written['all']}")
    if _is_same(actual, expected):
        return
    found = compare(actual, expected)
    if why := _too_different(found, _largest(actual, expected), max_steps, equal):
        parts: dict[str, npt.NDArray[Any]] = {"actual": actual, "expected": expected, "difference": found.picture}
        written = _write(Path(folder), _name(file), parts)
        raise AssertionError(f"{file}: {why}: {found}; FLIP {found.flip:.4f}. See {written['all']}. Where the new picture "
                             "is right, store it with update=True (pytest: --update-pictures)")


def _is_same(actual: Picture, expected: Picture) -> bool:
    return actual.shape == expected.shape and np.asarray(actual).tobytes() == np.asarray(expected).tobytes()


def _largest(actual: Picture, expected: Picture) -> int:
    """The largest difference of a channel, the opacity included."""
    return int(np.abs(np.asarray(actual, np.int16) - np.asarray(expected, np.int16)).max())


def _too_different(found: Comparison, largest: int, max_steps: int, equal: float | None) -> str | None:
    if equal is not None and found.equal < equal:
        return f"{100 * found.equal:.4f} % of the pixels are equal, expected at least {100 * equal:g} %"
    if largest > max_steps and (equal is None or max_steps > 0):
        expected = f"expected at most {max_steps}" if max_steps else "expected the same bytes"
        return f"channels differ by up to {largest} of 255, {expected}"
    return None


def _size(picture: Picture) -> str:
    return f"{picture.shape[1]} x {picture.shape[0]}"


def _name(file: Path) -> str:
    return re.sub(r"[^\w.\[\]-]+", "_", file.stem) or "picture"


def _write(folder: Path, name: str, parts: dict[str, npt.NDArray[Any]]) -> dict[str, Path]:
    folder.mkdir(parents=True, exist_ok=True)
    written = {}
    for part, picture in parts.items():
        written[part] = folder / f"{name}-{part}.png"
        Picture(picture).save(written[part])
    written["all"] = folder / f"{name}.png"
    beside(list(parts.values())).save(written["all"])
    return written


def beside(pictures: list[npt.NDArray[Any]]) -> Picture:
    """Pictures of bytes beside each other, on grey."""
    height = max(picture.shape[0] for picture in pictures)
    width = sum(picture.shape[1] for picture in pictures) + GAP * (len(pictures) - 1)
    sheet = np.full((height, width, 4), (128, 128, 128, 255), np.uint8)
    left = 0
    for picture in pictures:
        rows, columns = picture.shape[:2]
        sheet[:rows, left:left + columns] = np.asarray(picture)
        left += columns + GAP
    return Picture(sheet)
