"""Whatever is given, there is a picture or an exception that names the argument: never a panic, never a crash."""

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

import halfway

SIZE = (8, 6)
QUICK = settings(max_examples=150, deadline=None, suppress_health_check=list(HealthCheck))

numbers = st.one_of(st.floats(), st.integers(-(2**40), 2**40), st.booleans(), st.none(), st.text(max_size=6))
anything = st.recursive(
    numbers | st.binary(max_size=8) | st.just(object()),
    lambda inner: st.lists(inner, max_size=4) | st.tuples(inner, inner) | st.dictionaries(st.text(max_size=5), inner,
                                                                                         max_size=3),
    max_leaves=6,
)
any_array = arrays.arrays(
    st.sampled_from(["f4", "f8", "i4", "u1", "i8", "?", "c8", "U3"]),
    arrays.array_shapes(min_dims=0, max_dims=3, min_side=0, max_side=5),
)
some_array = any_array | anything


def refused(call):
    """Does what is asked; a refusal is one of the exceptions that the documentation names, with a message."""
    try:
        call()
    except (ValueError, TypeError, OSError, KeyError) as error:
        assert str(error)
    except RuntimeError as error:
        assert "mistake in halfway itself" not in str(error), error


@pytest.mark.filterwarnings("ignore")
class TestAnything:
    @QUICK
    @given(some_array, some_array)
    def test_arrays_of_a_mesh(self, vertices, faces):
        refused(lambda: halfway.render(vertices, faces, size=SIZE))

    @QUICK
    @given(arrays.arrays("f8", st.tuples(st.integers(1, 9), st.just(3))),
           arrays.arrays("i8", st.tuples(st.integers(1, 9), st.integers(3, 4)), elements=st.integers(-1, 9)))
    def test_arrays_that_are_nearly_right(self, vertices, faces):
        refused(lambda: halfway.render(vertices, faces, size=SIZE, outputs=["color", "depth", "id"]))

    @QUICK
    @given(st.sampled_from(["normals", "uvs", "colors", "face_colors", "image", "properties", "name"]), some_array)
    def test_arrays_beside_a_mesh(self, key, value):
        refused(lambda: halfway.Mesh(np.eye(3), [[0, 1, 2]], **{key: value}))

    @QUICK
    @given(st.sampled_from([*halfway.OPTIONS, "size", "camera", "time", "outputs", "poses", "floats"]),
           anything | st.text("abc0123456789.,=#-w", max_size=12))
    def test_options(self, key, value):
        if key in ("size", "samples") and not isinstance(value, (str, type(None))):
            value = np.clip(value, 0, 20) if isinstance(value, (int, float)) and value == value else str(value)[:3]
        refused(lambda: halfway.render(np.eye(3), [[0, 1, 2]], **{"size": SIZE, key: value}))

    @QUICK
    @given(st.sampled_from(["pose", "K", "size", "position", "target", "up", "fov_y_deg", "height", "near", "other"]),
           some_array)
    def test_cameras(self, key, value):
        refused(lambda: halfway.render(np.eye(3), [[0, 1, 2]], size=SIZE, camera=halfway.Camera(**{key: value})))

    @QUICK
    @given(st.sampled_from([halfway.PointLight, halfway.SpotLight, halfway.DirectionalLight, halfway.HemisphereLight]),
           st.sampled_from(["position", "direction", "color", "ambient", "attenuation", "range", "cutoff_deg", "sky",
                            "name", "attach", "layers", "animation"]), some_array)
    def test_lights(self, kind, key, value):
        def draw():
            scene = halfway.Scene((np.eye(3), [[0, 1, 2]]))
            scene.add_light(kind(**{key: value}))
            scene.render(size=SIZE)

        refused(draw)

    @QUICK
    @given(st.sampled_from(["material", "pose", "name", "color", "shading", "faces", "maps", "edges", "layers", "mesh",
                            "transform", "scalars", "solid", "displacement", "other"]), some_array)
    def test_objects(self, key, value):
        refused(lambda: halfway.Scene().add(np.eye(3), [[0, 1, 2]], **{key: value}))

    @QUICK
    @given(st.dictionaries(st.sampled_from(["objects", "lights", "camera", "size", "background", "samples"]), anything,
                           max_size=3) | anything)
    def test_scenes(self, contents):
        def draw():
            scene = halfway.Scene(contents)
            if "size" not in scene._data:
                scene.render(size=SIZE)

        refused(draw)

    @QUICK
    @given(some_array, some_array)
    def test_pictures(self, a, b):
        refused(lambda: halfway.compare(a, b))
        refused(lambda: halfway.Picture(a).png())
        refused(lambda: halfway.save_animation("/nonexistent/a.png", [a, b]))

    @QUICK
    @given(st.sampled_from([name for name in dir(halfway.equations) if name[0].islower()]), st.lists(some_array,
                                                                                               max_size=4))
    def test_equations(self, name, given_):
        function = getattr(halfway.equations, name)
        if callable(function) and function.__module__ == "halfway.equations":
            refused(lambda: function(*given_))


@pytest.mark.parametrize("call, kind, message", [
    (lambda m: halfway.render(np.eye(2), [[0, 1, 1]]), ValueError, r"vertices: shape \(2, 2\); expected \(n, 3\)"),
    (lambda m: halfway.render(np.eye(3), [[0, 1, 3]]), ValueError, r"faces\[0\]: index 3; expected 0 to 2"),
    (lambda m: halfway.render(np.eye(3), [[0.0, 1, 2]]), TypeError, "faces: .*float64; expected whole numbers"),
    (lambda m: halfway.render(np.full((3, 3), np.nan), [[0, 1, 2]]), ValueError, "position.*NaN"),
    (lambda m: halfway.render(7), TypeError, "mesh: int; expected vertices and faces, a path"),
    (lambda m: halfway.render("nothing.obj"), ValueError, "nothing.obj: cannot be read"),
    (lambda m: halfway.render("nothing.xyz"), ValueError, "nothing.xyz"),
    (lambda m: halfway.render(m, size=0), ValueError, "size: 0 x 0; expected 1 to 16384"),
    (lambda m: halfway.render(m, size="big"), TypeError, "size: 'big'; expected .width, height"),
    (lambda m: halfway.render(m, views="front"), TypeError, "unknown argument 'views'; expected one of view, up"),
    (lambda m: halfway.render(m, view="frnt"), ValueError, "view: \"frnt\": expected front, back"),
    (lambda m: halfway.render(m, samples=3), ValueError, "samples: \"3\": expected 1, 4, 16 or 64"),
    (lambda m: halfway.render(m, outputs=["dept"]), ValueError, "outputs: \"dept\"; expected color, depth"),
    (lambda m: halfway.render(m, outputs="depth"), TypeError, r"expected a list, such as \['depth'\]"),
    (lambda m: halfway.render(m, camera="left"), ValueError, "left"),
    (lambda m: halfway.render(m, camera=halfway.Camera(pose=np.eye(3))), ValueError, r"pose: shape \(3, 3\)"),
    (lambda m: halfway.render([m], poses=[]), ValueError, "poses: 0 of them; expected one for each of the 1"),
    (lambda m: halfway.Mesh(np.eye(3), [[0, 1, 2]], uvs=np.zeros((2, 2))), ValueError, "uvs: 2 rows; .* 3 vertices"),
    (lambda m: halfway.Material("brss"), ValueError, "preset: \"brss\"; expected one of emerald"),
    (lambda m: halfway.PointLight(color="lihgt"), ValueError, "color: \"lihgt\": expected a colour"),
])
def test_messages_name_the_argument_and_what_was_expected(call, kind, message):
    with pytest.raises(kind, match=message):
        call(halfway.Mesh(np.eye(3), [[0, 1, 2]]))
