"""Golden pictures, and the plugin for pytest."""

from importlib.metadata import entry_points

from importlib.metadata import entry_points

import numpy as np
import pytest

import halfway

pytest_plugins = ["pytester"]


@pytest.fixture
def image():
    rows, columns = np.mgrid[0:12, 0:16]
    return np.stack([rows * 9, columns * 9, rows + columns, np.full_like(rows, 255)], axis=2).astype(np.uint8)


def stored(folder, image):
    file = folder / "golden.png"
    halfway.check(image, file, update=True)
    return file


def test_equal_pictures_pass(tmp_path, image):
    file = stored(tmp_path, image)
    halfway.check(image, file, folder=tmp_path / "out")
    halfway.check(image[..., :3], file)
    halfway.check(file, file)
    assert not (tmp_path / "out").exists()


def test_one_byte_fails_and_says_where(tmp_path, image):
    file = stored(tmp_path, image)
    image[3, 5, 1] += 7
    with pytest.raises(AssertionError) as raised:
        halfway.check(image, file, folder=tmp_path / "out")
    said = str(raised.value)
    assert "7 of 255" in said and "(5, 3)" in said and "99.48 %" in said and "--update-pictures" in said
    names = sorted(path.name for path in (tmp_path / "out").iterdir())
    assert names == ["golden-actual.png", "golden-difference.png", "golden-expected.png", "golden.png"]
    difference = halfway.open(tmp_path / "out" / "golden-difference.png")
    together = halfway.open(tmp_path / "out" / "golden.png")
    assert together.shape[1] == 16 + 8 + 16 + 8 + difference.shape[1]
    assert np.array_equal(together[:12, :16], image)


def test_a_changed_opacity_fails(tmp_path, image):
    file = stored(tmp_path, image)
    image[0, 0, 3] = 254
    with pytest.raises(AssertionError, match="1 of 255"):
        halfway.check(image, file, folder=tmp_path / "out")


def test_bounds(tmp_path, image):
    file = stored(tmp_path, image)
    changed = image.copy()
    changed[0, 0, 0] += 2
    halfway.check(changed, file, max_steps=2)
    halfway.check(changed, file, equal=0.99)
    with pytest.raises(AssertionError, match="at most 1"):
        halfway.check(changed, file, max_steps=1, folder=tmp_path / "out")
    with pytest.raises(AssertionError, match="at least 99.9 %"):
        halfway.check(changed, file, equal=0.999, folder=tmp_path / "out")
    with pytest.raises(AssertionError, match="at most 1"):
        halfway.check(changed, file, equal=0.5, max_steps=1, folder=tmp_path / "out")


def test_a_missing_picture_says_how_to_make_it(tmp_path, image):
    with pytest.raises(AssertionError, match="no such golden picture.*update=True"):
        halfway.check(image, tmp_path / "none.png", folder=tmp_path / "out")
    assert np.array_equal(halfway.open(tmp_path / "out" / "none-actual.png"), image)


def test_another_size_fails(tmp_path, image):
    file = stored(tmp_path, image)
    with pytest.raises(AssertionError, match="16 x 11 pixels; expected 16 x 12"):
        halfway.check(image[:-1], file, folder=tmp_path / "out")


@pytest.mark.parametrize(("arguments", "error"), [
    ({"max_steps": -1}, "max_steps: -1; expected 0 to 255"),
    ({"max_steps": 0.5}, "max_steps: 0.5; expected 0 to 255"),
    ({"equal": 95}, "equal: 95; expected a share"),
])
def test_bad_bounds(tmp_path, image, arguments, error):
    file = stored(tmp_path, image)
    with pytest.raises(ValueError, match=error):
        halfway.check(image, file, **arguments)


def test_bad_files_and_pictures(tmp_path, image):
    with pytest.raises(ValueError, match=r"ends in \.png"):
        halfway.check(image, tmp_path / "a.jpg")
    with pytest.raises(TypeError, match="expected uint8"):
        halfway.check(image.astype(np.float32), tmp_path / "a.png")


MODULE = """
    import numpy as np
    import pytest
    import halfway

    VALUE = {value}

    def image(offset=0):
        return np.full((6, 8, 3), VALUE + offset, np.uint8)

    def test_one(picture):
        picture.check(image())

    def test_two(picture):
        picture.check(image(1), "left")
        picture.check(image(2), "right eye")

    @pytest.mark.parametrize("n", [3, 4])
    def test_many(picture, n):
        picture.check(image(n))

    class TestGroup:
        def test_one(self, picture):
            picture.check(image(5), max_steps=1)
"""


@pytest.fixture
def run(pytester):
    """Runs pytest with the plugin, which an installed package brings by itself."""

    is_installed = any(point.name == "halfway" for point in entry_points(group="pytest11"))
    plugin = [] if is_installed else ["-p", "halfway.pytest_plugin"]

    def run(*arguments):
        return pytester.runpytest_subprocess(*plugin, "-p", "no:cacheprovider", *arguments)

    return run


def test_plugin_updates_and_compares(pytester, run):
    pytester.makepyfile(test_mod=MODULE.format(value=100))
    run().assert_outcomes(failed=5)
    run("--update-pictures").assert_outcomes(passed=5)
    names = sorted(path.name for path in (pytester.path / "pictures" / "test_mod").iterdir())
    assert names == ["TestGroup-test_one.png", "test_many_3.png", "test_many_4.png", "test_one.png", "test_two-left.png",
                     "test_two-right_eye.png"]
    run().assert_outcomes(passed=5)
    pytester.makepyfile(test_mod=MODULE.format(value=101))
    result = run()
    result.assert_outcomes(failed=4, passed=1)
    result.stdout.fnmatch_lines(["*test_one.png: channels differ by up to 1 of 255, expected the same bytes*"])
    assert (pytester.path / "halfway-pictures" / "test_mod" / "test_one-difference.png").exists()


def test_plugin_writes_where_it_is_told(pytester, run):
    pytester.makepyfile(test_mod=MODULE.format(value=100))
    pytester.makeini("[pytest]\nhalfway_pictures = by_ini\n")
    run("-k", "test_one and not Group")
    assert (pytester.path / "by_ini" / "test_mod" / "test_one.png").exists()
    run("-k", "test_one and not Group", "--pictures-folder", "by_option")
    assert (pytester.path / "by_option" / "test_mod" / "test_one.png").exists()


def test_plugin_wants_a_name_for_each_picture(pytester, run):
    pytester.makepyfile(test_mod="""
        import numpy as np

        def test_twice(picture):
            picture.check(np.zeros((2, 2, 3), np.uint8))
            picture.check(np.zeros((2, 2, 3), np.uint8))
    """)
    result = run("--update-pictures")
    result.stdout.fnmatch_lines(["*test_twice.png was checked before in this test*"])
