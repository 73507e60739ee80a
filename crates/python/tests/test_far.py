"""Meshes and scenes far from the origin of the world, at map coordinates."""

from __future__ import annotations

import numpy as np
import pytest

import halfway

FAR = [(400_000.25, 5_000_000.5, 0.0), (1e9, 1e9, 1e9)]

WALLS = np.array([[0, 0, 0], [9.3, 0, 0], [9.3, 0, 6.1], [0, 0, 6.1], [0, 4.7, 0], [9.3, 4.7, 0], [9.3, 4.7, 6.1],
                  [0, 4.7, 6.1], [4.65, 7.2, 3.05]])
FACES = np.array([[0, 1, 5], [0, 5, 4], [1, 2, 6], [1, 6, 5], [2, 3, 7], [2, 7, 6], [3, 0, 4], [3, 4, 7],
                  [4, 5, 8], [5, 6, 8], [6, 7, 8], [7, 4, 8]])


def differing(a: object, b: object) -> float:
    """The share of pixels that differ by more than a step."""
    return float((np.abs(np.asarray(a).astype(int) - np.asarray(b)).max(axis=2) > 1).mean())


@pytest.mark.parametrize("origin", FAR)
@pytest.mark.parametrize("keys", [{}, {"view": "iso", "shading": "flat"}])
def test_arrays(origin: tuple[float, float, float], keys: dict[str, str]) -> None:
    near = halfway.render(WALLS, FACES, size=(160, 120), **keys)
    far = halfway.render(WALLS + origin, FACES, size=(160, 120), **keys)
    assert differing(near, far) < 0.005
    # As f32 the walls are elsewhere: the planted fault.
    rounded = halfway.render((WALLS + origin).astype(np.float32), FACES, size=(160, 120), **keys)
    assert differing(near, rounded) > 0.005


@pytest.mark.parametrize("origin", FAR)
def test_numbers_come_back(origin: tuple[float, float, float]) -> None:
    mesh = halfway.Mesh(WALLS + origin, FACES)
    assert mesh.vertices.dtype == np.float64
    assert np.abs(mesh.vertices - (WALLS + origin)).max() < 1e-6
    assert np.abs(mesh.bounds - [origin, WALLS.max(axis=0) + origin]).max() < 1e-6
    assert halfway.Mesh(WALLS, FACES).vertices.dtype == np.float32


@pytest.mark.parametrize("origin", FAR)
def test_a_scene_is_composed_and_moved_far_away(origin: tuple[float, float, float]) -> None:
    def picture(at: np.ndarray) -> np.ndarray:
        scene = halfway.Scene()
        pose = np.eye(4)
        pose[:3, 3] = at
        house = scene.add(halfway.Mesh(WALLS, FACES), pose=pose)
        scene.add_light(halfway.PointLight(position=at + [12, 14, 16]))
        scene.camera = halfway.Camera(position=at + [20, 12, 20], target=at + [4, 2, 2])
        scene.render(size=(160, 120))
        house.position = at + [0.25, 0.5, 0.25]
        assert np.abs(house.position - (at + [0.25, 0.5, 0.25])).max() < 1e-6
        return np.asarray(scene.render(size=(160, 120)))

    assert differing(picture(np.zeros(3)), picture(np.array(origin))) < 0.005
