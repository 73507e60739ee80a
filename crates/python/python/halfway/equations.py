"""The equations of lighting as functions on arrays, in 64-bit arithmetic: those of the reference renderer.

Vectors have the shape (..., 3) and unit length; numbers and vectors are broadcast against one another. n is the normal, l
the direction to the light, v the direction to the viewer.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from . import _halfway
from ._arguments import Color, linear

Array = npt.NDArray[np.float64]


def _evaluate(name: str, vectors: dict[str, npt.ArrayLike], numbers: dict[str, npt.ArrayLike], is_vector: bool) -> Any:
    given = {key: np.asarray(value, np.float64) for key, value in {**vectors, **numbers}.items()}
    for key in vectors:
        if given[key].ndim == 0 or given[key].shape[-1] != 3:
            raise ValueError(f"{key}: shape {given[key].shape}; expected (..., 3)")
    try:
        shape = np.broadcast_shapes(*(value.shape[:-1] if key in vectors else value.shape
                                      for key, value in given.items()))
    except ValueError:
        shapes = ", ".join(f"{key} {value.shape}" for key, value in given.items())
        raise ValueError(f"{name}: shapes that do not fit: {shapes}") from None
    count = int(np.prod(shape, dtype=int))
    flat = [np.ascontiguousarray(np.broadcast_to(given[key], (*shape, 3))).reshape(-1) for key in vectors]
    plain = [np.ascontiguousarray(np.broadcast_to(given[key], shape)).reshape(-1) for key in numbers]
    found = np.frombuffer(_halfway.evaluate(name, flat, plain, count), np.float64)
    return found.reshape((*shape, 3) if is_vector else shape)[()]


def reflect(l: npt.ArrayLike, n: npt.ArrayLike) -> Array:  # noqa: E741
    """r = 2 (n·l) n − l, the direction of l mirrored about n."""
    return _evaluate("reflect", {"l": l, "n": n}, {}, True)  # type: ignore[no-any-return]


def half_vector(l: npt.ArrayLike, v: npt.ArrayLike) -> Array:  # noqa: E741
    """h = (l + v) / ‖l + v‖; 0 where l and v are opposite."""
    return _evaluate("half_vector", {"l": l, "v": v}, {}, True)  # type: ignore[no-any-return]


def diffuse(n: npt.ArrayLike, l: npt.ArrayLike) -> Any:  # noqa: E741
    """max(n·l, 0): Lambert's cosine."""
    return _evaluate("diffuse", {"n": n, "l": l}, {}, False)


def specular_phong(n: npt.ArrayLike, l: npt.ArrayLike, v: npt.ArrayLike, shininess: npt.ArrayLike) -> Any:  # noqa: E741
    """max(r·v, 0)^shininess, and 0 where n·l ≤ 0: Phong 1975."""
    return _evaluate("specular_phong", {"n": n, "l": l, "v": v}, {"shininess": shininess}, False)


def specular_blinn_phong(n: npt.ArrayLike, l: npt.ArrayLike, v: npt.ArrayLike, shininess: npt.ArrayLike) -> Any:  # noqa: E741
    """max(n·h, 0)^shininess, and 0 where n·l ≤ 0: Blinn 1977."""
    return _evaluate("specular_blinn_phong", {"n": n, "l": l, "v": v}, {"shininess": shininess}, False)


def attenuation(d: npt.ArrayLike, a: npt.ArrayLike = 1.0, b: npt.ArrayLike = 0.0, c: npt.ArrayLike = 0.0) -> Any:
    """1 / (a + b d + c d²) at the distance d, at most 10⁶."""
    return _evaluate("attenuation", {}, {"a": a, "b": b, "c": c, "d": d}, False)


def spot_factor(cos_phi: npt.ArrayLike, cutoff_deg: npt.ArrayLike = 30.0, exponent: npt.ArrayLike = 0.0,
                inner_deg: npt.ArrayLike | None = None) -> Any:
    """cos^exponent of the angle φ from the axis, 0 beyond the cutoff; between an inner angle and the cutoff it fades."""
    inner = np.nan if inner_deg is None else np.cos(np.radians(inner_deg))
    numbers = {"cos_phi": cos_phi, "cos_cutoff": np.cos(np.radians(cutoff_deg)), "exponent": exponent, "inner": inner}
    return _evaluate("spot_factor", {}, numbers, False)


def srgb_encoded(linear: npt.ArrayLike) -> Any:
    """The sRGB curve, from linear intensities to 0 to 1."""
    return _evaluate("srgb_encoded", {}, {"linear": linear}, False)


def phong(n: npt.ArrayLike, l: npt.ArrayLike, v: npt.ArrayLike, *, ka: Color = (0.2, 0.2, 0.2),  # noqa: E741
          kd: Color = (0.8, 0.8, 0.8), ks: Color = (0.0, 0.0, 0.0), shininess: float = 32.0,
          ambient: Color = (0.1, 0.1, 0.1), light: Color = (1.0, 1.0, 1.0), weight: npt.ArrayLike = 1.0) -> Array:
    """I = ka·Ga + w·(kd·L·max(n·l, 0) + ks·L·max(r·v, 0)^shininess) for one light, with its attenuation and cone as
    `weight`; the colours are linear RGB."""
    return _lit(specular_phong(n, l, v, shininess), n, l, (ka, kd, ks), ambient, light, weight)


def blinn_phong(n: npt.ArrayLike, l: npt.ArrayLike, v: npt.ArrayLike, *, ka: Color = (0.2, 0.2, 0.2),  # noqa: E741
                kd: Color = (0.8, 0.8, 0.8), ks: Color = (0.0, 0.0, 0.0), shininess: float = 32.0,
                ambient: Color = (0.1, 0.1, 0.1), light: Color = (1.0, 1.0, 1.0),
                weight: npt.ArrayLike = 1.0) -> Array:
    """As `phong`, with max(n·h, 0)^shininess."""
    return _lit(specular_blinn_phong(n, l, v, shininess), n, l, (ka, kd, ks), ambient, light, weight)


def _lit(specular: Any, n: Any, l: Any, coefficients: Any, ambient: Any, light: Any, weight: Any) -> Array:  # noqa: E741
    ka, kd, ks = (np.array(linear(color, name)) for color, name in zip(coefficients, ("ka", "kd", "ks")))
    of_light, around = np.array(linear(light, "light")), np.array(linear(ambient, "ambient"))
    d, s, w = (np.asarray(value)[..., None] for value in (diffuse(n, l), specular, weight))
    lit: Array = ka * around + w * of_light * (kd * d + ks * s)
    return lit
