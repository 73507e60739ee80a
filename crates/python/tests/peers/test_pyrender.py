"""halfway.pyrender beside the real pyrender: silhouettes, segmentation and depth are the same, colours look alike."""

import os
import warnings

os.environ.setdefault("PYOPENGL_PLATFORM", "egl")

import numpy as np
import pytest

trimesh = pytest.importorskip("trimesh")

import halfway.pyrender as drop_in
from halfway import SceneWarning

SIZE = (160, 120)


@pytest.fixture(scope="module")
def real():
    """pyrender, where it is installed and finds an OpenGL."""
    pyrender = pytest.importorskip("pyrender")
    if not hasattr(np, "infty"):
        np.infty = np.inf  # pyrender 0.1 asks for it, numpy 2 has it no more
    try:
        renderer = pyrender.OffscreenRenderer(8, 8)
        renderer.delete()
    except Exception as error:  # noqa: BLE001
        pytest.skip(f"pyrender finds no OpenGL here: {error}")
    return pyrender


def turned(angle, axis, place=(0, 0, 0)):
    pose = trimesh.transformations.rotation_matrix(angle, axis)
    pose[:3, 3] = place
    return pose


CAMERAS = {
    "perspective": lambda p: p.PerspectiveCamera(yfov=np.pi / 3.5),
    "far": lambda p: p.PerspectiveCamera(yfov=np.pi / 3.5, zfar=4.0),
    "aspect": lambda p: p.PerspectiveCamera(yfov=np.pi / 3.5, aspectRatio=1.0),
    "orthographic": lambda p: p.OrthographicCamera(xmag=1.5, ymag=1.5),
    "intrinsics": lambda p: p.IntrinsicsCamera(fx=170, fy=150, cx=70, cy=66),
}


def scene_of(p, camera="perspective"):
    """The same scene by either package."""
    scene = p.Scene(bg_color=[0.2, 0.3, 0.4, 1.0], ambient_light=[0.2, 0.2, 0.2])
    red = p.MetallicRoughnessMaterial(baseColorFactor=[0.8, 0.2, 0.1, 1.0], metallicFactor=0.0, roughnessFactor=0.6)
    box = trimesh.creation.box((1, 1, 1))
    box.visual.face_colors = [[200, 60, 40, 255]] * 4 + [[40, 180, 60, 255]] * 4 + [[50, 80, 220, 255]] * 4
    cylinder = trimesh.creation.cylinder(0.4, 1.2, sections=40)
    nodes = [
        scene.add(p.Mesh.from_trimesh(trimesh.creation.icosphere(subdivisions=4), material=red), name="ball"),
        scene.add(p.Mesh.from_trimesh(box, smooth=False), pose=turned(0.7, [1, 2, 3], (1.2, 0.3, 0.2))),
        scene.add(p.Mesh.from_trimesh(cylinder, smooth=False), pose=turned(0, [0, 0, 1], (-1.3, -0.3, 0.3))),
    ]
    scene.add(CAMERAS[camera](p), pose=turned(0, [0, 0, 1], (0.2, 0.4, 4)))
    scene.add(p.DirectionalLight(color=[1.0, 1.0, 1.0], intensity=2.0), pose=turned(-0.6, [1, 0.3, 0]))
    scene.add(p.PointLight(color=[1.0, 0.8, 0.6], intensity=8.0), pose=turned(0, [0, 0, 1], (2, 2, 2)))
    spot = p.SpotLight(color=[0.6, 0.8, 1.0], intensity=8.0, innerConeAngle=0.1, outerConeAngle=0.4)
    scene.add(spot, pose=turned(0.3, [0, 1, 0], (-1, 0.5, 3)))
    return scene, nodes


def drawn(p, flags=0, camera="perspective", change=None):
    scene, nodes = scene_of(p, camera)
    renderer = p.OffscreenRenderer(*SIZE)
    colors = {node: (i + 1) * 20 for i, node in enumerate(nodes)}
    if change is not None:
        renderer.render(scene, flags, colors)
        change(scene, nodes)
    found = renderer.render(scene, flags, colors)
    renderer.delete()
    return found


def inner(*masks):
    """Pixels whose neighbours are all of the same kind."""
    kept = np.ones(masks[0].shape, bool)
    for mask in masks:
        for axis in (0, 1):
            for step in (-1, 1):
                kept &= mask == np.roll(mask, step, axis)
    return kept


@pytest.mark.parametrize("camera", CAMERAS)
def test_segments_and_depth_are_the_same(real, camera):
    theirs, their_depth = drawn(real, 8192, camera)
    ours, depth = drawn(drop_in, drop_in.RenderFlags.SEG, camera)
    assert ours.shape == theirs.shape and ours.dtype == theirs.dtype and depth.dtype == their_depth.dtype
    assert (ours != theirs).any(axis=2).mean() < 0.001
    both = (depth > 0) & (their_depth > 0)
    assert both.sum() > 2000 and ((depth > 0) != (their_depth > 0)).mean() < 0.001
    if camera == "orthographic":
        # pyrender reads the depth of all cameras as a perspective one's; lengths are those of the scene here.
        assert 2.5 < depth[both].min() < 3.2 and depth.max() < 5
        return
    # pyrender's depth has 24 bits between the planes, and is that of the pixel's first sample.
    assert np.median(np.abs(depth - their_depth)[both]) < 0.01


def test_depth_alone(real):
    theirs, ours = drawn(real, 1), drawn(drop_in, drop_in.RenderFlags.DEPTH_ONLY)
    assert ours.shape == theirs.shape and ours.dtype == theirs.dtype
    kept = inner(ours > 0, theirs > 0) & (ours > 0)
    assert np.percentile(np.abs(ours - theirs)[kept], 95) < 0.03
    assert (ours[:4] == 0).all()


def test_colors_look_alike(real):
    theirs, their_depth = drawn(real)
    ours, depth = drawn(drop_in)
    assert ours.shape == theirs.shape and ours.dtype == theirs.dtype
    empty = (depth == 0) & (their_depth == 0)
    assert (np.abs(ours.astype(int) - theirs)[inner(empty) & empty] <= 1).all()
    assert np.abs(ours.astype(int) - theirs).mean() < 6


def test_flat_colors_are_the_same(real):
    theirs, their_depth = drawn(real, 4096)
    ours, depth = drawn(drop_in, drop_in.RenderFlags.FLAT)
    steps = np.abs(ours.astype(int) - theirs).max(axis=2)
    assert (steps <= 1).mean() > 0.95


def test_moving_changes_the_picture_as_theirs(real):
    def change(scene, nodes):
        scene.set_pose(nodes[1], turned(0.2, [0, 1, 0], (0.9, -0.5, 0.6)))
        scene.remove_node(nodes[2])

    theirs, _ = drawn(real, 8192, change=change)
    ours, _ = drawn(drop_in, 8192, change=change)
    assert (ours != theirs).any(axis=2).mean() < 0.001 and 60 not in ours


def test_moved_scenes_are_those_that_stood_there():
    def change(scene, nodes):
        scene.set_pose(nodes[0], turned(0.3, [0, 1, 0], (0.1, 0.2, 0.3)))
        scene.set_pose(scene.main_camera_node, turned(0.1, [0, 1, 0], (0.6, 0.4, 4)))
        for node in scene.point_light_nodes:
            scene.set_pose(node, turned(0, [0, 1, 0], (0, 3, 1)))

    moved, _ = drawn(drop_in, change=change)
    scene, nodes = scene_of(drop_in)
    change(scene, nodes)
    stood, _ = drop_in.OffscreenRenderer(*SIZE).render(scene)
    assert np.array_equal(moved, stood)


def test_a_changed_material_is_seen():
    scene, nodes = scene_of(drop_in)
    renderer = drop_in.OffscreenRenderer(*SIZE)
    before, _ = renderer.render(scene)
    nodes[0].mesh.primitives[0].material.baseColorFactor = [0.0, 0.0, 1.0, 1.0]
    after, _ = renderer.render(scene)
    assert (before != after).any()
    nodes[0].mesh.is_visible = False
    hidden, _ = renderer.render(scene)
    assert (hidden != after).any()


def test_a_tree_of_nodes(real):
    found = []
    for p in (real, drop_in):
        scene = p.Scene()
        arm = scene.add(p.Mesh.from_trimesh(trimesh.creation.box((0.4, 0.4, 0.4))), name="arm",
                        pose=turned(0.4, [0, 0, 1], (0.3, 0, 0)))
        hand = scene.add(p.Mesh.from_trimesh(trimesh.creation.box((0.3, 0.3, 0.3))), name="hand", parent_name="arm",
                         pose=turned(0.2, [1, 0, 0], (0.5, 0.1, 0)))
        assert scene.get_nodes(name="hand") == {hand} and arm.children == [hand]
        found.append((scene.get_pose(hand), scene.bounds, scene.scale, hand.rotation))
        scene.remove_node(arm)
        assert not scene.mesh_nodes and not scene.has_node(hand)
    for theirs, ours in zip(*found):
        assert np.allclose(theirs, ours, atol=1e-6)


def test_textures_and_poses():
    grid = trimesh.Trimesh([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], [[0, 1, 2], [0, 2, 3]])
    image = np.zeros((16, 16, 3), np.uint8)
    image[:8, :8] = 255, 0, 0
    image[8:, 8:] = 0, 0, 255
    material = drop_in.MetallicRoughnessMaterial(baseColorTexture=image, alphaMode="OPAQUE")
    grid.visual = trimesh.visual.TextureVisuals(uv=[[0, 0], [1, 0], [1, 1], [0, 1]])
    poses = np.stack([turned(0, [0, 0, 1], (x, 0, 0)) for x in (-1.2, 1.2)])
    scene = drop_in.Scene(bg_color=[0.0, 0.0, 0.0])
    scene.add(drop_in.Mesh.from_trimesh(grid, material=material, poses=poses))
    scene.add(drop_in.OrthographicCamera(1, 2.0), pose=turned(0, [0, 0, 1], (0, 0, 3)))
    color, depth = drop_in.OffscreenRenderer(120, 80).render(scene, drop_in.RenderFlags.FLAT)
    # Upper left red, lower right blue, of both.
    for middle in (36, 84):
        assert color[24, middle - 16].tolist() == [255, 0, 0] and color[56, middle + 16].tolist() == [0, 0, 255]
    assert np.allclose(depth[40, 36], 3)


def textured(p, metallic, grey=200):
    """A ball with an image of stripes."""
    ball = trimesh.creation.uv_sphere(radius=1, count=[32, 32])
    angle = np.arctan2(ball.vertices[:, 1], ball.vertices[:, 0])
    ball.visual = trimesh.visual.TextureVisuals(uv=np.stack([angle / 6.2832 + 0.5, ball.vertices[:, 2] / 2 + 0.5], axis=1))
    image = np.zeros((64, 64, 3), np.uint8)
    image[::16], image[1::16], image[8:16] = (220, 60, 40), (220, 60, 40), (40, 90, 200)
    image[image.sum(axis=2) == 0] = grey
    material = p.MetallicRoughnessMaterial(baseColorTexture=image, baseColorFactor=[0.8, 0.9, 1.0, 1.0],
                                           metallicFactor=metallic, roughnessFactor=0.5)
    scene = p.Scene(bg_color=[0.0, 0.0, 0.0], ambient_light=[0.2, 0.2, 0.2])
    scene.add(p.Mesh.from_trimesh(ball, material=material), pose=turned(1.4, [-1, 0, 0]))
    scene.add(p.PerspectiveCamera(yfov=0.9), pose=turned(0, [0, 0, 1], (0, 0, 3)))
    scene.add(p.DirectionalLight(intensity=3.0), pose=turned(-0.5, [1, 0.5, 0]))
    return scene, material


@pytest.mark.parametrize("metallic", [0.0, 1.0])
def test_images_look_alike(real, metallic):
    theirs, _ = real.OffscreenRenderer(*SIZE).render(textured(real, metallic)[0])
    ours, depth = drop_in.OffscreenRenderer(*SIZE).render(textured(drop_in, metallic)[0])
    assert np.abs(ours.astype(int) - theirs)[depth > 0].mean() < 14


def test_a_changed_image_is_seen():
    scene, material = textured(drop_in, 0.0)
    renderer = drop_in.OffscreenRenderer(*SIZE)
    before, _ = renderer.render(scene)
    material = next(iter(scene.mesh_nodes)).mesh.primitives[0].material
    material.baseColorTexture = 255 - material.baseColorTexture
    assert (renderer.render(scene)[0] != before).any()
    renderer.delete()


def test_scenes_of_trimesh():
    source = trimesh.Scene()
    source.add_geometry(trimesh.creation.box((1, 1, 1)), transform=turned(0, [0, 0, 1], (0, 0, 1)))
    scene = drop_in.Scene.from_trimesh_scene(source, bg_color=[0, 0, 0])
    assert np.allclose(scene.bounds, [[-0.5, -0.5, 0.5], [0.5, 0.5, 1.5]])


def test_opacity_and_background():
    scene = drop_in.Scene(bg_color=[0.0, 0.0, 0.0, 0.0], ambient_light=[1.0, 1.0, 1.0])
    glass = drop_in.MetallicRoughnessMaterial(baseColorFactor=[1.0, 1.0, 1.0, 0.5], alphaMode="BLEND")
    scene.add(drop_in.Mesh.from_trimesh(trimesh.creation.box((1, 1, 1)), material=glass, smooth=False))
    scene.add(drop_in.PerspectiveCamera(yfov=0.8), pose=turned(0, [0, 0, 1], (0, 0, 3)))
    color, _ = drop_in.OffscreenRenderer(40, 30).render(scene, drop_in.RenderFlags.RGBA)
    assert color[0, 0].tolist() == [0, 0, 0, 0] and 120 < color[15, 20, 3] < 136


def test_what_cannot_be_drawn_is_said():
    scene, _ = scene_of(drop_in)
    renderer = drop_in.OffscreenRenderer(16, 12)
    drop_in._warned.clear()
    with pytest.warns(SceneWarning, match="no shadows"):
        renderer.render(scene, drop_in.RenderFlags.SHADOWS_DIRECTIONAL)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        renderer.render(scene, drop_in.RenderFlags.SHADOWS_ALL)
    with pytest.raises(NotImplementedError, match="PLY"):
        drop_in.Mesh.from_points(np.zeros((3, 3)))
    with pytest.raises(NotImplementedError, match="OffscreenRenderer"):
        drop_in.Viewer(scene)
    with pytest.raises(ValueError, match="no camera"):
        renderer.render(drop_in.Scene())
    with pytest.raises(ValueError, match="seg_node_map"):
        renderer.render(scene, drop_in.RenderFlags.SEG)
    with pytest.raises(TypeError, match="expected a Mesh, a Light or a Camera"):
        scene.add("cube")
