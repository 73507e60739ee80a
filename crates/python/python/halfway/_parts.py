"""The parts of a scene that are made before it: cameras, lights and materials, as the keys of scene files."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from . import _halfway
from ._arguments import Color, Vector, linear, matrix, numbers, size_of

COLORS = ("ambient", "diffuse", "specular", "emission", "sky", "ground")


class Material(dict[str, Any]):
    """How a surface reflects: the coefficients `ambient` (ka), `diffuse` (kd), `specular` (ks) and `emission` (ke), the
    exponent `shininess` and the `opacity`. Colours are text as CSS has it, or linear red, green and blue.

    `Material("brass")` is a preset, one of `halfway.PRESETS`; `Material(color="teal")` a colour with a little highlight.
    """

    def __init__(self, preset: str | None = None, *, color: Color | None = None, **keys: Any) -> None:
        super().__init__()
        if preset is not None:
            self.update(_halfway.preset(preset))
        if color is not None:
            from ._mesh import finish

            self.update(finish(linear(color, "color")))
        self.update({key: linear(value, key) if key in COLORS else value for key, value in keys.items()})


class Light(dict[str, Any]):
    """A light, as the keys that scene files have. `color` is that of its diffuse and specular light; both may be named
    apart. Colours are text as CSS has it, or linear red, green and blue, which may be above 1."""

    kind = "point"

    def __init__(self, *, color: Color | None = None, name: str | None = None, **keys: Any) -> None:
        super().__init__(kind=self.kind)
        if name is not None:
            self["name"] = name
        if color is not None:
            self["diffuse"] = self["specular"] = linear(color, "color")
        self.update({key: linear(value, key) if key in COLORS else value for key, value in keys.items()})


class PointLight(Light):
    """Light from a point in all directions: `position`, `attenuation` (a, b, c), `range`."""


class SpotLight(Light):
    """Light from a point into a cone: `position`, `direction`, `cutoff_deg`, `inner_deg`, `exponent`."""

    kind = "spot"


class DirectionalLight(Light):
    """Parallel rays: `direction` is the way the light travels."""

    kind = "directional"


class HemisphereLight(Light):
    """Light from all around: `sky` and `ground` are its colours, `direction` points to the sky."""

    kind = "hemisphere"


class Camera(dict[str, Any]):
    """A camera, as the keys that scene files have: `position`, `target`, `up`, and `fov_y_deg`, or `height` for a view
    without perspective.

    `pose` is a matrix of 4 by 4 from the camera to the world, in place of `position`, `target` and `up`: the camera looks
    along its −Z, with +Y up, as in OpenGL. `K` is a matrix of intrinsics of 3 by 3, in pixels from the upper left corner
    of a picture of `size`, that of the pictures unless said; the middle of the first pixel is at (0.5, 0.5).
    """

    def __init__(
        self,
        *,
        pose: npt.ArrayLike | None = None,
        K: npt.ArrayLike | None = None,
        size: tuple[int, int] | None = None,
        **keys: Any,
    ) -> None:
        super().__init__(keys)
        if pose is not None:
            if clash := [key for key in ("position", "target", "up", "view") if key in keys]:
                raise ValueError(f"{clash[0]}: cannot stand beside pose, which says it all")
            self.update(placed_by(pose))
        if K is not None:
            self["intrinsics"] = intrinsics(K, None if size is None else size_of(size))

    @classmethod
    def from_opencv(cls, K: npt.ArrayLike, R: npt.ArrayLike, t: Vector, size: tuple[int, int], **keys: Any) -> Camera:
        """A camera as OpenCV has it: x = K (R X + t), x to the right, y down, z forward, the middle of the first pixel at
        (0, 0)."""
        world_to_camera = np.eye(4)
        world_to_camera[:3, :3], world_to_camera[:3, 3] = np.asarray(R, float), numbers(t, "t", 3)
        pose = np.linalg.inv(world_to_camera) @ np.diag([1.0, -1.0, -1.0, 1.0])
        moved = np.array(K, float)
        moved[:2, 2] += 0.5
        return cls(K=moved, pose=pose, size=size, **keys)


def placed_by(pose: npt.ArrayLike) -> dict[str, Any]:
    """The place of a camera by a matrix from the camera to the world."""
    m = matrix(pose, "pose").astype(float)
    position, back, up = m[:3, 3], m[:3, 2], m[:3, 1]
    if not np.linalg.norm(back) or not np.linalg.norm(up):
        raise ValueError("pose: an axis of the camera has no length")
    # As far away as the camera is from the origin, so that single precision keeps the direction.
    reach = max(1.0, float(np.linalg.norm(position)))
    target = position - reach * back / np.linalg.norm(back)
    return {"position": position.tolist(), "target": target.tolist(), "up": up.tolist()}


def intrinsics(K: npt.ArrayLike, size: tuple[int, int] | None) -> dict[str, Any]:
    """The intrinsics of a camera; without a size they are still to get that of the picture."""
    k = np.asarray(K, float)
    if k.shape != (3, 3):
        raise ValueError(f"K: shape {k.shape}; expected (3, 3)")
    if k[0, 1] or k[1, 0] or k[2].tolist() != [0, 0, 1]:
        raise ValueError(f"K: {k.tolist()}; expected [[fx, 0, cx], [0, fy, cy], [0, 0, 1]], without skew")
    found: dict[str, Any] = {"focal": [k[0, 0], k[1, 1]], "center": [k[0, 2], k[1, 2]]}
    return found if size is None else found | {"size": list(size)}
