"""Fixtures that the tests share."""

from pathlib import Path

import numpy as np
import pytest

import halfway

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture
def box():
    """The vertices and the triangles of a box."""
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
    quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    return corners, np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])


@pytest.fixture
def scene():
    """A teapot, a lamp and a camera that stands."""
    scene = halfway.Scene()
    scene.add({"teapot": {"divisions": 4}}, name="pot", material="brass")
    scene.add_light(halfway.PointLight(name="lamp", position=(2, 3, 2)))
    scene.camera = halfway.Camera(position=(0, 2, 6), target=(0, 1, 0))
    return scene
