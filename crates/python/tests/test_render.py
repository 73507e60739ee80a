"""Pictures of meshes by one call."""

import numpy as np
import pytest

import halfway
from conftest import ROOT

SIZE = (96, 64)
LANTERN = ROOT / "assets/lantern.glb"


def test_a_picture_of_arrays(box):
    picture = halfway.render(*box, size=SIZE)
    assert picture.shape == (64, 96, 4) and picture.dtype == np.uint8
    assert (picture[..., 3] == 255).all()
    # The box is light before a dark background, and it is in the middle.
    assert picture[32, 48, :3].min() > 90 > 60 > picture[0, 0, :3].max()


def test_ways_to_give_a_mesh_draw_the_same(box):
    expected = halfway.render(*box, size=SIZE)
    vertices, faces = box
    quads = np.c_[faces[::2], faces[1::2, 2]]
    for given in [(vertices, faces), halfway.Mesh(vertices, faces), [halfway.Mesh(vertices, faces)],
                  (vertices.tolist(), faces.tolist()), (vertices.astype("f4"), quads),
                  (np.asfortranarray(vertices), faces.astype("i2"))]:
        assert (halfway.render(given, size=SIZE) == expected).all()


def test_the_names_of_the_command_are_arguments(box):
    plain = halfway.render(*box, size=SIZE)
    for name, value in {
        "view": (10, 60), "up": "z", "ortho": True, "fit": 0.5, "zoom": 2, "color": "teal", "faces": "back",
        "normals": "smooth", "background": "white", "lights": "headlight", "shading": "unlit", "edges": "all",
        "wireframe": True, "show": ["axes", "grid"], "samples": 1,
    }.items():
        assert not np.array_equal(halfway.render(*box, size=SIZE, **{name: value}), plain), name
    assert set(halfway.Options.__annotations__) == set(halfway.OPTIONS)


def test_colours_are_text_or_linear_numbers(box):
    by_name = halfway.render(*box, size=SIZE, background="#808080", color="#ff8000")
    grey, half = (((v / 255 + 0.055) / 1.055) ** 2.4 for v in (128, 128))
    by_number = halfway.render(*box, size=SIZE, background=(grey,) * 3, color=(1, half, 0))
    assert by_name.diff(by_number).max_steps <= 1
    two = halfway.render(*box, size=SIZE, background="white..black")
    assert two[0, 0, 0] > 240 and two[-1, 0, 0] < 30
    clear = halfway.render(*box, size=SIZE, background="transparent")
    assert clear[0, 0, 3] == 0 and clear[32, 48, 3] == 255


def test_outputs_are_arrays_of_their_kinds(box):
    outputs = halfway.render(*box, size=SIZE, outputs=["color", *halfway.OUTPUTS], view="front", ortho=True)
    assert list(outputs) == ["color", *halfway.OUTPUTS]
    assert (outputs["color"] == halfway.render(*box, size=SIZE, view="front", ortho=True)).all()
    hit = outputs["id"] == 1
    assert outputs["id"].dtype == np.uint32 and hit[32, 48] and not hit[0, 0]
    assert outputs["depth"].shape == (64, 96) and (outputs["depth"][~hit] == 0).all()
    np.testing.assert_allclose(outputs["position"][hit][:, 2], 1, atol=1e-5)
    np.testing.assert_allclose(outputs["normal"][32, 48], (0, 0, 1), atol=1e-6)
    np.testing.assert_allclose(outputs["barycentrics"][hit].sum(1), 1, atol=1e-6)
    # Depth along the axis and position belong together.
    assert np.ptp(outputs["depth"][hit] + outputs["position"][hit][:, 2]) < 1e-4


def test_terms_sum_to_the_picture(box):
    terms = ["ambient", "diffuse", "specular", "emission"]
    for draw in (halfway.render, halfway.reference):
        alone = draw(*box, size=SIZE, floats=True, samples=1, outputs=["color", "depth", *terms])
        assert list(alone) == ["color", "depth", *terms]
        assert alone["diffuse"].shape == (64, 96, 3) and alone["diffuse"].max() > 0.1
        # Nothing is above 1 there, so that nothing is clamped.
        assert alone["color"][..., :3].max() < 1.0
        np.testing.assert_allclose(sum(alone[term] for term in terms), alone["color"][..., :3], atol=1e-6)
        again = draw(*box, size=SIZE, floats=True, samples=1)
        assert (again == alone["color"]).all()
    with pytest.raises(ValueError, match="one term only"):
        halfway.render(*box, size=SIZE, only="diffuse", outputs=["specular"])


def test_floats_are_linear_intensities(box):
    floats = halfway.render(*box, size=SIZE, floats=True, samples=1)
    encoded = halfway.render(*box, size=SIZE, samples=1)
    assert floats.dtype == np.float32
    expected = np.round(halfway.equations.srgb_encoded(np.clip(floats[..., :3], 0, 1)) * 255)
    assert np.abs(expected - encoded[..., :3]).max() <= 1


def test_a_camera_by_pose_and_intrinsics_is_the_camera_by_angles(box):
    position = np.array([3.0, 2.0, 4.0])
    back = position / np.linalg.norm(position)
    right = np.cross((0, 1, 0), back)
    right /= np.linalg.norm(right)
    pose = np.eye(4)
    pose[:3] = np.c_[right, np.cross(back, right), back, position]
    by_angle = halfway.Camera(position=position, target=(0, 0, 0), fov_y_deg=50)
    focal = 32 / np.tan(np.radians(25))
    K = [[focal, 0, 48], [0, focal, 32], [0, 0, 1]]
    expected = halfway.render(*box, size=SIZE, camera=by_angle, outputs=["depth", "id"])
    for camera in (halfway.Camera(K=K, pose=pose), halfway.Camera(K=K, pose=pose, size=SIZE)):
        found = halfway.render(*box, size=SIZE, camera=camera, outputs=["depth", "id"])
        assert (found["id"] == expected["id"]).mean() > 0.999
        np.testing.assert_allclose(found["depth"], expected["depth"], rtol=1e-5, atol=1e-4)
    turned = np.diag([1.0, -1.0, -1.0, 1.0]) @ np.linalg.inv(pose)
    centre = np.array(K) - [[0, 0, 0.5], [0, 0, 0.5], [0, 0, 0]]
    opencv = halfway.Camera.from_opencv(centre, turned[:3, :3], turned[:3, 3], SIZE)
    assert (halfway.render(*box, size=SIZE, camera=opencv, outputs=["id"])["id"] == expected["id"]).mean() > 0.999


def test_several_meshes_with_poses(box):
    left, right = np.eye(4), np.eye(4)
    left[0, 3], right[0, 3] = -3, 3
    ids = halfway.render([box, box], poses=[left, right], size=SIZE, view="front", outputs=["id"])["id"]
    assert set(ids[:, :48].ravel()) == {0, 1} and set(ids[:, 48:].ravel()) == {0, 2}


def test_models_and_scene_files_are_read():
    model = halfway.render(LANTERN, size=SIZE)
    assert model.std() > 10
    scene = halfway.render(ROOT / "examples/scenes/light_kinds.json", size=SIZE)
    assert scene.shape == (64, 96, 4) and scene.std() > 10


def test_colours_of_vertices_and_faces(box):
    vertices, faces = box
    red = np.tile(np.uint8([255, 0, 0]), (8, 1))
    by_vertex = halfway.render(halfway.Mesh(vertices, faces, colors=red), size=SIZE, shading="unlit")
    by_face = halfway.render(halfway.Mesh(vertices, faces, face_colors=np.tile(np.uint8([255, 0, 0]), (12, 1))),
                             size=SIZE, shading="unlit")
    assert (by_vertex == by_face).all()
    # The grey of models without a material.
    assert by_vertex[32, 48, 0] > 200 and by_vertex[32, 48, 1] == 0


def test_an_image_lies_as_its_coordinates_say():
    quad = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], float)
    image = np.zeros((2, 2, 3), np.uint8)
    image[0, 0], image[0, 1], image[1, 0], image[1, 1] = (255, 0, 0), (0, 255, 0), (0, 0, 255), (255, 255, 255)
    uvs = [[0, 0], [1, 0], [1, 1], [0, 1]]
    mesh = halfway.Mesh(quad, [[0, 1, 2, 3]], uvs=uvs, image=image)
    picture = halfway.render(mesh, size=(64, 64), view="front", ortho=True, shading="unlit", fit=1.0)
    assert picture[16, 16, :3].argmax() == 0 and picture[16, 48, :3].argmax() == 1
    assert picture[48, 16, :3].argmax() == 2 and picture[48, 48, :3].min() > 200


def test_numbers_are_shown_by_colours(box):
    vertices, faces = box
    mesh = halfway.Mesh(vertices, faces, properties={"height": vertices[:, 1]})
    assert mesh.properties == ["height"]
    shown = halfway.render(mesh, size=SIZE, view="front", scalars="height", map="blue_red", shading="unlit")
    column = shown[:, 48, :3].astype(int)
    rows = np.flatnonzero(column.sum(1) > 150)
    assert column[rows[2], 0] > column[rows[2], 2] and column[rows[-3], 2] > column[rows[-3], 0]


def test_sheets_turntables_and_animations(box, tmp_path):
    sheet = halfway.sheet(halfway.Mesh(*box), views=["front", "30,20"], size=SIZE)
    assert sheet.shape[1] > 2 * SIZE[0] and sheet.shape[0] > SIZE[1]
    frames = halfway.turntable(halfway.Mesh(*box), frames=4, size=SIZE)
    assert len(frames) == 4 and not (frames[0] == frames[1]).all()
    assert (frames[0] == halfway.render(*box, size=SIZE)).all()
    halfway.animate(halfway.Mesh(*box), tmp_path / "turn.png", frames=3, size=SIZE)
    assert b"acTL" in (tmp_path / "turn.png").read_bytes()


def test_a_scene_of_nothing_says_so(box):
    behind = halfway.Camera(position=(0, 0, 5), target=(0, 0, 9))
    with pytest.warns(halfway.SceneWarning, match="shows nothing: .*behind the camera"):
        halfway.render(*box, size=SIZE, camera=behind)


def test_a_pixel_is_explained(box):
    scene = halfway.Scene(halfway.Mesh(*box))
    picture = scene.reference(size=SIZE)
    for at in [(48, 32), (40, 30), (0, 0)]:
        explained = scene.explain(at, size=SIZE)
        assert explained.bytes == tuple(picture.array[at[1], at[0], :3])
        assert explained["pixel"] == list(at) and len(explained["samples"]) == 4
    flat = halfway.explain(scene, (48, 32), size=SIZE, samples=1, shading="flat", intensity="clamp")
    (layer,) = flat["samples"][0]["layers"]
    light = layer["points"][0]["lights"][0]
    assert layer["points"][0]["at"] == "triangle" and light["kind"] == "directional"
    sums = np.sum([layer["sums"][term] for term in ("ambient", "diffuse", "specular")], axis=0)
    assert np.allclose(sums + layer["emission"], layer["intensity"], atol=1e-12)
    assert flat.color == pytest.approx(layer["intensity"], abs=1e-12)
    assert str(flat) == flat.text and "flat shading" in flat.text and flat.latex.startswith("\\begin{align*}")
    with pytest.raises(ValueError, match="lies outside the picture"):
        scene.explain((SIZE[0], 0), size=SIZE)
    for bad, error in [((1,), TypeError), ((1.5, 2), TypeError), ((-1, 2), ValueError)]:
        with pytest.raises(error, match="at: "):
            scene.explain(bad, size=SIZE)


def test_one_term_and_one_light_alone(box):
    scene = halfway.Scene()
    scene.add(halfway.Mesh(*box), material=halfway.Material(diffuse=(0.5, 0.5, 0.5), ambient=(0.5, 0.5, 0.5), specular=(0.3, 0.3, 0.3)))
    scene.add_light(halfway.PointLight(name="key", position=(2, 4, 3)))
    scene.add_light(halfway.DirectionalLight(name="fill", direction=(-1, -1, -1), ambient=(0.1, 0.2, 0.3)))
    draw = lambda **options: scene.render(size=SIZE, floats=True, samples=1, **options).array[..., :3]
    terms = sum(draw(only=term) for term in ("ambient", "diffuse", "specular", "emission"))
    assert np.allclose(terms, draw(), rtol=1e-5, atol=1e-6)
    key = draw(light="key")
    assert np.array_equal(key, draw(light=0)) and not np.allclose(key, draw(light="fill"))
    assert np.allclose(key, sum(draw(light="key", only=term) for term in ("ambient", "diffuse", "specular")), rtol=1e-5, atol=1e-6)
    with pytest.raises(ValueError, match='no light is called "kye"; there are 0 "key", 1 "fill"'):
        draw(light="kye")
    with pytest.raises(ValueError, match="expected ambient, diffuse, specular or emission"):
        draw(only="shiny")


def test_pictures_are_marked(box):
    scene = halfway.Scene(halfway.Mesh(*box, name="box"))
    picture = scene.reference(size=SIZE, samples=1)
    right = halfway.mark(picture, scene)
    assert right.passes and right.mistakes == [] and right["mark"] == right["points"] == 100
    mirrored = np.ascontiguousarray(picture.array[:, ::-1])
    wrong = scene.mark(mirrored, rubric={"points": 10, "mistakes": {"mirrored": 4}})
    assert not wrong.passes and wrong.mistakes == ["mirrored"] and wrong["mark"] == 6, wrong.text
    assert "6 of 10 points" in wrong.text and "explains" in str(wrong) and "6 of 10" in repr(wrong)
    with pytest.raises(ValueError, match='rubric: unknown key "point"; expected points, mistake'):
        scene.mark(mirrored, rubric={"point": 1})
    with pytest.raises(FileNotFoundError):
        scene.mark(mirrored, rubric="nowhere.json")


def test_the_reference_renderer_draws_the_same(box):
    scene = halfway.Scene(halfway.Mesh(*box))
    picture = scene.render(size=SIZE)
    assert scene.verify(scene.render(size=SIZE, samples=1))["within"]
    wrong = picture.array.copy()
    wrong[30:34, 46:50, 0] += 9
    assert not scene.verify(wrong)["within"]
    assert halfway.reference(*box, size=SIZE, samples=1).diff(scene.render(size=SIZE, samples=1)).equal > 0.95
