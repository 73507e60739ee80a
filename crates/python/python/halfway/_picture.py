"""Pictures as arrays that can be saved, compared and seen."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _halfway


class Picture(np.ndarray[Any, np.dtype[Any]]):
    """An array of shape (height, width, 4), the top row first: red, green, blue and opacity.

    Numbers of type `uint8` are encoded (sRGB unless `encoding` says raw), those of type `float32` are linear
    intensities. A picture is a numpy array; parts of it, and results of computations, are plain arrays.
    """

    encoding: str = "srgb"

    def __new__(cls, array: npt.ArrayLike, encoding: str = "srgb") -> Picture:
        values = np.asarray(array)
        if values.ndim == 2:
            values = np.repeat(values[:, :, None], 3, axis=2)
        if values.ndim != 3 or values.shape[2] not in (3, 4) or 0 in values.shape:
            raise ValueError(f"picture: shape {values.shape}; expected (height, width, 3) or (height, width, 4)")
        if values.dtype != np.uint8:
            if values.dtype.kind != "f":
                raise TypeError(f"picture: numbers of type {values.dtype}; expected uint8, or floats for intensities")
            values = values.astype(np.float32, copy=False)
        if values.shape[2] == 3:
            opaque = np.full((*values.shape[:2], 1), 255 if values.dtype == np.uint8 else 1.0, values.dtype)
            values = np.concatenate([values, opaque], axis=2)
        picture = np.ascontiguousarray(values).view(cls)
        picture.encoding = encoding
        return picture

    def __array_finalize__(self, source: npt.NDArray[Any] | None) -> None:
        self.encoding = getattr(source, "encoding", "srgb")

    def __getitem__(self, key: Any) -> Any:
        return np.asarray(self)[key]

    def __array_wrap__(self, array: npt.NDArray[Any], *_: Any) -> Any:
        return np.asarray(array)[()] if array.ndim == 0 else np.asarray(array)

    def __reduce__(self) -> Any:
        return _restored, (np.asarray(self), self.encoding)

    @property
    def array(self) -> npt.NDArray[Any]:
        """The same numbers as a plain array."""
        return np.asarray(self)

    @property
    def _size(self) -> tuple[int, int]:
        return self.shape[1], self.shape[0]

    def save(self, file: str | os.PathLike[str], bits: int | None = None) -> None:
        """Writes a file that ends in .png (8 bits a channel, or 16), .jpg, .webp or, of floats, .exr."""
        _halfway.save(os.fspath(file), _buffer(self), self._size, bits, self.encoding)

    def png(self) -> bytes:
        """The bytes of a PNG of 8 bits a channel."""
        return _halfway.png(_buffer(self), self._size, self.encoding)

    def diff(self, other: npt.ArrayLike) -> Comparison:
        """How this picture differs from another, the expected one: figures, and a picture."""
        return compare(self, other)

    def _repr_png_(self) -> bytes:
        return self.png()


def _restored(array: npt.NDArray[Any], encoding: str) -> Picture:
    return Picture(array, encoding)


def _buffer(picture: npt.NDArray[Any]) -> npt.NDArray[Any]:
    return np.ascontiguousarray(np.asarray(picture))


def as_picture(picture: npt.ArrayLike | str | os.PathLike[str]) -> Picture:
    """A picture from an array, from what Pillow has, or from a file."""
    if isinstance(picture, Picture):
        return picture
    if isinstance(picture, (str, os.PathLike)):
        return open_picture(picture)
    return Picture(picture)


def from_pixels(width: int, height: int, is_float: bool, pixels: bytearray) -> Picture:
    """The picture of what the compiled half has drawn; the memory is not copied."""
    array = np.frombuffer(pixels, np.float32 if is_float else np.uint8).reshape(height, width, 4)
    return array.view(Picture)


def open_picture(file: str | os.PathLike[str]) -> Picture:
    """Reads a PNG, or an EXR as floats."""
    return from_pixels(*_halfway.open(os.fspath(file)))


@dataclass(frozen=True)
class Comparison:
    """How two pictures differ. Steps are of 1/255, in the encoding of the pictures."""

    equal: float
    """The share of pixels that are equal in all three bytes."""
    max_steps: int
    """The largest difference of a channel."""
    at: tuple[int, int]
    """Column and row of the largest difference."""
    mean_steps: float
    """The mean of the absolute differences."""
    rmse_steps: float
    """The root of the mean square of the differences."""
    rmse_linear: float
    """The same of linear intensities."""
    flip: float
    """The mean of ꟻLIP: how much of a difference an eye sees that switches from one to the other, 0 to 1."""
    picture: Picture
    """Where they differ, with a legend."""

    def __str__(self) -> str:
        column, row = self.at
        return (f"{100 * self.equal:.2f} % of the pixels are equal; the largest difference is {self.max_steps} of 255, "
                f"at ({column}, {row}); mean {self.mean_steps:.4f}")


def compare(actual: npt.ArrayLike | str, expected: npt.ArrayLike | str) -> Comparison:
    """Compares a picture with an expected one of the same size: arrays, or files."""
    a, b = as_picture(actual), as_picture(expected)
    if a.shape != b.shape:
        raise ValueError(f"pictures of {a.shape[1]} x {a.shape[0]} and of {b.shape[1]} x {b.shape[0]} pixels; "
                         "expected the same size")
    both = (_buffer(a), _buffer(b), a._size, a.encoding)
    return Comparison(**_halfway.compare(*both), picture=from_pixels(*_halfway.diff(*both)))


def save_animation(file: str | os.PathLike[str], frames: Sequence[npt.ArrayLike], fps: int = 30) -> None:
    """Writes pictures of one size as an animated PNG that repeats without end."""
    pictures = [as_picture(frame) for frame in frames]
    if not pictures:
        raise ValueError("frames: there are none; expected at least one picture")
    if not 1 <= fps <= 1000:
        raise ValueError(f"fps: {fps}; expected 1 to 1000 frames a second")
    first = pictures[0]
    for number, picture in enumerate(pictures):
        if picture.shape != first.shape or picture.dtype != np.uint8:
            raise ValueError(f"frames[{number}]: shape {picture.shape} of {picture.dtype}; expected {first.shape} of "
                             "uint8, as the first frame")
    buffers = [_buffer(picture) for picture in pictures]
    _halfway.save_animation(os.fspath(file), buffers, first._size, fps, first.encoding)
