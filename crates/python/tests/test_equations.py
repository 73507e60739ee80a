"""The equations against what numpy computes."""

import numpy as np
import pytest

from halfway import blinn_phong, equations, phong


def unit(rng, *shape):
    v = rng.normal(size=(*shape, 3))
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def test_the_textbook_s_formulas():
    rng = np.random.default_rng(1)
    n, l, v = (unit(rng, 50) for _ in range(3))
    nl = (n * l).sum(1)
    r, h = 2 * nl[:, None] * n - l, (l + v) / np.linalg.norm(l + v, axis=1)[:, None]
    np.testing.assert_allclose(equations.reflect(l, n), r, atol=1e-14)
    np.testing.assert_allclose(equations.half_vector(l, v), h, atol=1e-14)
    np.testing.assert_allclose(equations.diffuse(n, l), nl.clip(0), atol=1e-15)
    of_phong = np.where(nl > 0, (r * v).sum(1).clip(0) ** 20, 0)
    of_blinn = np.where(nl > 0, (n * h).sum(1).clip(0) ** 20, 0)
    np.testing.assert_allclose(equations.specular_phong(n, l, v, 20), of_phong, rtol=1e-11, atol=1e-300)
    np.testing.assert_allclose(equations.specular_blinn_phong(n, l, v, 20), of_blinn, rtol=1e-11, atol=1e-300)
    lit = 0.2 * 0.1 + 0.5 * (0.8 * nl.clip(0) + 0.3 * of_phong)
    found = phong(n, l, v, ks=(0.3,) * 3, shininess=20, weight=0.5)
    np.testing.assert_allclose(found, np.repeat(lit[:, None], 3, 1), atol=1e-12)
    assert not np.allclose(found, blinn_phong(n, l, v, ks=(0.3,) * 3, shininess=20, weight=0.5))


def test_falloff():
    d = np.linspace(0, 5, 11)
    np.testing.assert_allclose(equations.attenuation(d, 1, 0.1, 0.2), 1 / (1 + 0.1 * d + 0.2 * d * d))
    assert equations.attenuation(0.0, 0) == pytest.approx(1e6)
    cosines = np.cos(np.radians([0, 29, 31]))
    np.testing.assert_allclose(equations.spot_factor(cosines, 30, 2), [1, cosines[1] ** 2, 0])
    assert 0 < equations.spot_factor(np.cos(np.radians(25)), 30, 0, inner_deg=20) < 1


def test_shapes_are_broadcast_and_checked():
    assert phong([0, 0, 1], np.zeros((4, 5, 3)) + [0, 0, 1], [0, 0, 1]).shape == (4, 5, 3)
    assert np.ndim(equations.diffuse([0, 0, 1], [0, 0, 1])) == 0
    with pytest.raises(ValueError, match=r"n: shape \(2,\); expected \(..., 3\)"):
        equations.diffuse([0, 1], [0, 0, 1])
    with pytest.raises(ValueError, match="shapes that do not fit"):
        equations.diffuse(np.zeros((2, 3)), np.zeros((4, 3)))
