"""Scenes that are composed, changed and drawn again."""

import json
import pickle

import numpy as np
import pytest

import halfway
from conftest import ROOT

SIZE = (96, 64)


def fresh(scene, **arguments):
    """The picture of a new scene with the same contents."""
    return halfway.Scene(json.loads(halfway._arguments.as_json(scene._data))).render(size=SIZE, **arguments)


def test_what_is_moved_is_drawn_as_a_new_scene_would_be(scene):
    first = scene.render(size=SIZE)
    changes = [
        lambda: setattr(scene["lamp"], "position", (-2, 3, 2)),
        lambda: setattr(scene["pot"], "position", (0.5, 0, 0)),
        lambda: setattr(scene["pot"], "pose", np.diag([1, -1, 2, 1])),
        lambda: setattr(scene["pot"], "pose", [[1, 0.5, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]),
        lambda: setattr(scene["pot"], "position", (0.3, 0, 0)),
        lambda: setattr(scene.camera, "position", (1, 2, 6)),
        lambda: setattr(scene.camera, "target", (0, 0, 0)),
        lambda: scene.camera.set(height=5, fov_y_deg=None),
        lambda: scene["lamp"].set(color=None, diffuse="teal", range=9),
        lambda: scene["pot"].set(shading="flat", material={"diffuse": (1, 0.5, 0)}),
        lambda: scene.set(background="navy", ambient=(0.3, 0.3, 0.3)),
        lambda: scene.add({"box": {}}, name="box", pose=np.diag([2.5, 2.5, 2.5, 1])),
        lambda: scene.remove("box"),
        lambda: scene["lamp"].set(kind="directional", position=None, attenuation=None, range=None, direction=(0, -1, -1)),
        lambda: setattr(scene, "camera", halfway.Camera(view="iso")),
        lambda: setattr(scene["pot"], "position", (3, 0, 0)),
    ]
    before = first
    for number, change in enumerate(changes):
        change()
        drawn = scene.render(size=SIZE)
        assert (drawn == fresh(scene)).all(), number
        if number != len(changes) - 1:  # A camera that frames the pot follows it.
            assert not (drawn == before).all(), number
        before = drawn


def test_pictures_of_several_options_do_not_disturb_each_other(scene):
    views = [{"view": view} for view in ("front", "left", "top", "iso", "back", "30,60")] + [{}, {"shading": "flat"}]
    first = [scene.render(size=SIZE, **options) for options in views]
    scene["lamp"].position = (-1, 3, 2)
    moved = [scene.render(size=SIZE, **options) for options in views]
    for options, picture, other in zip(views, moved, first):
        assert (picture == fresh(scene, **options)).all(), options
        assert not (picture == other).all(), options
    scene["lamp"].position = (2, 3, 2)
    assert all((scene.render(size=SIZE, **options) == picture).all() for options, picture in zip(views, first))


def test_many_objects_are_placed_at_once(scene):
    boxes = [scene.add({"box": {}}, pose=np.diag([0.2, 0.2, 0.2, 1])) for _ in range(5)]
    poses = np.tile(np.diag([0.2, 0.2, 0.2, 1]).astype("f4"), (5, 1, 1))
    poses[:, 0, 3] = np.arange(5) - 2
    scene.render(size=SIZE)
    scene.place(boxes, poses)
    assert (scene.render(size=SIZE) == fresh(scene)).all()
    np.testing.assert_array_equal(boxes[3].position, (1, 0, 0))


def test_entries_are_found_by_name_and_names_are_unique(scene):
    assert isinstance(scene["pot"], halfway.SceneObject) and isinstance(scene["lamp"], halfway.SceneLight)
    with pytest.raises(KeyError, match="'pot', 'lamp'"):
        scene["kettle"]
    with pytest.raises(ValueError, match="name: 'lamp' is taken"):
        scene.add({"box": {}}, name="lamp")


def test_a_scene_file_is_the_command_s(tmp_path):
    file = ROOT / "examples/scenes/light_kinds.json"
    scene = halfway.Scene(file)
    picture = scene.render()
    assert picture.shape[:2] == tuple(reversed(json.loads(file.read_text()).get("size", [1280, 720])))
    scene.save(tmp_path / "copy.json")
    assert (halfway.Scene(tmp_path / "copy.json", base_dir=file.parent).render() == picture).all()


def test_an_animation_is_played():
    scene = halfway.Scene(ROOT / "examples/scenes/key_frames.json")
    assert not (scene.render(size=SIZE, time=0.0) == scene.render(size=SIZE, time=0.5)).all()
    with pytest.raises(ValueError, match="time: 0.5; the scene has no animation"):
        halfway.Scene({"objects": [{"mesh": {"box": {}}}]}).render(size=SIZE, time=0.5)


def test_the_animation_of_a_model_is_chosen(tmp_path):
    # A triangle that goes aside in one animation and stays in the other.
    lists = [[0, 0, 0, 1, 0, 0, 0, 1, 0], [0, 1], [0, 0, 0, 5, 0, 0], [0] * 6]
    data = [np.asarray(numbers, "<f4").tobytes() for numbers in lists]
    starts = np.cumsum([0, *map(len, data)]).tolist()
    accessors = [
        {"bufferView": 0, "byteOffset": start, "componentType": 5126, "type": kind, "count": count}
        for start, kind, count in zip(starts, ["VEC3", "SCALAR", "VEC3", "VEC3"], [3, 2, 2, 2])
    ]
    accessors[0] |= {"min": [0, 0, 0], "max": [1, 1, 0]}
    animations = [
        {
            "name": name,
            "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
            "samplers": [{"input": 1, "output": places}],
        }
        for name, places in [("go", 2), ("stay", 3)]
    ]
    file = tmp_path / "model.gltf"
    (tmp_path / "model.bin").write_bytes(b"".join(data))
    model = {
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": accessors,
        "bufferViews": [{"buffer": 0, "byteLength": starts[-1]}],
        "buffers": [{"byteLength": starts[-1], "uri": "model.bin"}],
        "animations": animations,
    }
    file.write_text(json.dumps(model))

    def moves(**options):
        with pytest.warns(halfway.SceneWarning):
            first, later = [halfway.render(file, size=SIZE, time=time, **options) for time in (0.0, 0.9)]
        return not (first == later).all()

    assert moves() and moves(animation="go") and moves(animation=0)
    assert not moves(animation="stay") and not moves(animation=1)
    with pytest.raises(ValueError, match='animation.*is "run".*0 "go", 1 "stay"'):
        halfway.render(file, size=SIZE, animation="run")


@pytest.mark.parametrize("break_it, message", [
    (lambda s: s["pot"].set(shading="round"), "shading.*round"),
    (lambda s: s["pot"].set(metal=1), "unknown key `metal`"),
    (lambda s: s["pot"].set(material={"shininess": -1}), "material.shininess"),
    (lambda s: s["lamp"].set(attenuation=(-1, 0, 0)), "attenuation"),
    (lambda s: s.set(fog=1), "unknown key `fog`"),
    (lambda s: s.set(background="grue"), "background.*grue"),
    (lambda s: s.camera.set(fov_y_deg=200), "fov_y_deg"),
    (lambda s: s["pot"].set(material="bras"), "no preset is named"),
])
def test_what_is_wrong_is_said_with_its_key_and_changes_nothing(scene, break_it, message):
    before = json.dumps(json.loads(halfway._arguments.as_json(scene._data)))
    with pytest.raises((ValueError, TypeError), match=message):
        break_it(scene)
    assert json.dumps(json.loads(halfway._arguments.as_json(scene._data))) == before


def test_a_bad_scene_file_is_named_with_its_line(tmp_path):
    file = tmp_path / "bad.json"
    file.write_text('{\n  "objects": [{"mesh": {"bx": {}}}]\n}')
    with pytest.raises(ValueError, match=r"bad.json:2.*bx"):
        halfway.Scene(file)


def test_pictures_are_arrays(scene, tmp_path):
    picture = scene.render(size=SIZE)
    assert type(picture[..., 0]) is np.ndarray and type(picture / 2) is np.ndarray
    assert type(picture.mean()) is np.float64
    assert picture.array.base is not None
    again = pickle.loads(pickle.dumps(picture))
    assert type(again) is halfway.Picture and (again == picture).all()
    for name in ("a.png", "a.webp"):
        picture.save(tmp_path / name)
    assert (halfway.open(tmp_path / "a.png") == picture).all()
    floats = scene.render(size=SIZE, floats=True)
    floats.save(tmp_path / "a.exr")
    assert (halfway.open(tmp_path / "a.exr")[..., :3] == floats[..., :3]).all()
    assert picture._repr_png_().startswith(b"\x89PNG") and scene._repr_png_().startswith(b"\x89PNG")
    with pytest.raises(ValueError, match=r"a\.bmp.*\.png"):
        picture.save(tmp_path / "a.bmp")
    with pytest.raises(ValueError, match="expected the same size"):
        picture.diff(picture[:-1])
