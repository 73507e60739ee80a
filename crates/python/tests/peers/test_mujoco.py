"""halfway.mujoco beside MuJoCo's own classic renderer: the same segments and depth; colours off edges within a few steps."""

import os
import warnings

os.environ.setdefault("MUJOCO_GL", "egl")

import numpy as np
import pytest

mujoco = pytest.importorskip("mujoco")

import halfway.mujoco as drop_in
from halfway import SceneWarning

LIGHTS = """
<light pos="0 -1 3" dir="0 .3 -1" diffuse=".6 .6 .5" specular=".4 .4 .4" castshadow="false"/>
<light pos="2 -2 3" dir="-1 1 -1.5" directional="true" diffuse=".3 .3 .4" castshadow="false"/>
"""
IS_NEW = int(mujoco.__version__.split(".")[0]) >= 4
ORTHOGRAPHIC = 'projection="orthographic"' if IS_NEW else 'orthographic="true"'
SHAPES = f"""<mujoco><visual><headlight ambient=".1 .1 .1" diffuse=".3 .3 .3" specular=".2 .2 .2"/></visual><worldbody>{LIGHTS}
<camera name="side" pos="3 -2 1.5" xyaxes=".55 .83 0 -.3 .2 .93" fovy="40"/>
<camera name="flat" pos="0 -2 3" xyaxes="1 0 0 0 .8 .6" {ORTHOGRAPHIC} fovy="3"/>
<camera name="lens" pos="0 -2 3" xyaxes="1 0 0 0 .8 .6" resolution="160 120" focal=".04 .04" sensorsize=".04 .03"
 principal=".005 -.004"/>
<geom type="plane" size="2 2 .1" rgba=".6 .6 .5 1"/>
<geom type="sphere" pos="-1 0 .3" size=".3" rgba=".9 .2 .1 1"/>
<geom type="capsule" pos="-.3 0 .5" size=".15 .3" rgba=".2 .8 .2 1" euler="20 30 0"/>
<geom type="ellipsoid" pos=".4 .1 .4" size=".25 .15 .35" rgba=".2 .3 .9 1" euler="0 20 10"/>
<geom type="cylinder" pos="1.1 0 .4" size=".2 .35" rgba=".8 .8 .2 1" euler="30 0 20"/>
<geom type="box" pos="0 -.9 .25" size=".3 .2 .2" rgba=".7 .3 .8 1" euler="0 10 30"/>
<body name="moves" pos=".8 -.8 .5"><freejoint/><geom type="box" size=".15 .15 .15" rgba=".9 .6 .1 1"/></body>
</worldbody></mujoco>"""
TEXTURES = f"""<mujoco><asset>
<texture name="checks" type="2d" builtin="checker" width="64" height="64" rgb1=".1 .2 .3" rgb2=".8 .3 .4"/>
<material name="whole" texture="checks" texrepeat="4 3" shininess=".8" specular=".6"/>
<material name="even" texture="checks" texrepeat="3 2" texuniform="true"/>
<material name="shiny" rgba=".3 .5 .9 1" specular="1" shininess=".9" emission=".2"/>
<mesh name="roof" vertex="-.4 -.3 0 .4 -.3 0 .4 .3 0 -.4 .3 0 0 0 .5" texcoord="0 0 1 0 1 1 0 1 .5 .5"
 face="0 1 4 1 2 4 2 3 4 3 0 4 0 3 2 0 2 1"/>
<hfield name="hill" nrow="20" ncol="30" size=".5 .4 .3 .1"/></asset><worldbody>{LIGHTS}
<geom type="plane" size="1.5 1 .1" material="whole"/>
<geom type="plane" size=".5 .7 .1" material="even" pos="0 0 .01"/>
<geom type="hfield" hfield="hill" pos="0 .5 .2" rgba=".5 .7 .4 1"/>
<geom type="mesh" mesh="roof" pos="-.9 -.4 .1" material="shiny"/>
<geom type="box" pos="1 -.6 .25" size=".2 .2 .2" rgba=".7 .3 .8 .5"/>
</worldbody></mujoco>"""
SIZE = {"height": 120, "width": 160}


def loaded(xml):
    model = mujoco.MjModel.from_xml_string(xml)
    if model.nhfield:
        y, x = np.mgrid[0:20, 0:30]
        model.hfield_data[:] = (0.5 + 0.5 * np.sin(x / 4) * np.cos(y / 3)).reshape(-1)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    return model, data


@pytest.fixture(scope="module")
def real():
    """MuJoCo's renderer, where it finds an OpenGL."""
    try:
        mujoco.Renderer(loaded(SHAPES)[0], 8, 8).close()
    except Exception as error:  # noqa: BLE001
        pytest.skip(f"mujoco.Renderer finds no OpenGL here: {error}")

    def make(model):
        renderer = mujoco.Renderer(model, **SIZE)
        # Without shadows, reflections and haze, which halfway does not draw.
        for flag in (mujoco.mjtRndFlag.mjRND_SHADOW, mujoco.mjtRndFlag.mjRND_REFLECTION, mujoco.mjtRndFlag.mjRND_HAZE):
            renderer.scene.flags[flag] = 0
        return renderer

    return make


def pictures(renderer, data, camera):
    renderer.update_scene(data, camera)
    color = renderer.render()
    renderer.enable_depth_rendering()
    depth = renderer.render()
    renderer.disable_depth_rendering()
    renderer.enable_segmentation_rendering()
    segments = renderer.render()
    renderer.disable_segmentation_rendering()
    return color, depth, segments


def off_edges(segments):
    kept = np.ones(segments.shape[:2], bool)
    for axis in (0, 1):
        for step in (-1, 1):
            kept &= (segments == np.roll(segments, step, axis)).all(axis=2)
    return kept


@pytest.mark.parametrize(("xml", "camera"), [
    (SHAPES, -1), (SHAPES, "side"), (SHAPES, 0), (SHAPES, "flat"), (SHAPES, "lens"), (TEXTURES, -1),
])
def test_pictures_are_the_same_off_edges(real, xml, camera):
    model, data = loaded(xml)
    theirs = pictures(real(model), data, camera)
    with drop_in.Renderer(model, **SIZE) as renderer:
        ours = pictures(renderer, data, camera)
    for a, b in zip(theirs, ours):
        assert a.shape == b.shape and a.dtype == b.dtype
    segments = theirs[2]
    assert (segments != ours[2]).any(axis=2).mean() < 0.002
    assert len(np.unique(segments.reshape(-1, 2), axis=0)) >= 5
    same = (segments == ours[2]).all(axis=2)
    assert np.abs(theirs[1] - ours[1])[same].max() < 0.03
    kept = off_edges(segments) & same
    steps = np.abs(theirs[0].astype(int) - ours[0]).max(axis=2)[kept]
    # Shapes have edges of their own, as checks have; MuJoCo sees highlights of orthographic cameras from their place.
    assert np.percentile(steps, 90) <= (2 if camera != "flat" and xml is SHAPES else 8)
    assert np.percentile(steps, 97) <= (4 if camera != "flat" and xml is SHAPES else 32)


def test_what_moves_is_drawn_where_it_is(real):
    model, data = loaded(SHAPES)
    theirs, ours = real(model), drop_in.Renderer(model, **SIZE)
    ours.update_scene(data, "side")
    before = ours.render()
    data.qpos[:3] = 0.3, -0.4, 1.1
    mujoco.mj_forward(model, data)
    for camera in ("side", -1, "side"):
        a, b = pictures(theirs, data, camera), pictures(ours, data, camera)
        assert (a[2] != b[2]).any(axis=2).mean() < 0.002
        fresh = drop_in.Renderer(model, **SIZE)
        assert np.array_equal(pictures(fresh, data, camera)[0], b[0])
    assert (before != b[0]).any()


def test_colors_and_sizes_that_change_are_seen():
    model, data = loaded(SHAPES)
    renderer = drop_in.Renderer(model, **SIZE)
    renderer.update_scene(data)
    first = renderer.render()
    model.geom_rgba[1] = 0, 0, 1, 1
    renderer.update_scene(data)
    second = renderer.render()
    model.geom_size[1] = 0.5
    model.geom_rbound[1] = 0.5
    renderer.update_scene(data)
    third = renderer.render()
    assert (first != second).any() and (second != third).any()
    model.vis.headlight.diffuse[:] = 0.9
    renderer.update_scene(data)
    assert renderer.render().mean() > third.mean()


def test_geoms_that_are_added(real):
    model, data = loaded(SHAPES)
    found = []
    for renderer in (real(model), drop_in.Renderer(model, **SIZE)):
        renderer.update_scene(data)
        scene = renderer.scene
        for kind, x in (("SPHERE", 0.0), ("ARROW", 0.7), ("ARROW1", -0.5), ("ARROW2", -1.2)):
            mujoco.mjv_initGeom(scene.geoms[scene.ngeom], getattr(mujoco.mjtGeom, f"mjGEOM_{kind}"), np.array([0.1, 0.1, 0.8]), np.array([x, 0.0, 1.0]),
                                np.eye(3).flatten(), np.array([1, 1, 1, 1], np.float32))
            scene.ngeom += 1
        found.append(renderer.render())
    theirs, ours = found
    assert (theirs.min(axis=2) > 150).sum() > 60
    assert (np.abs(theirs.astype(int) - ours).max(axis=2) > 32).mean() < 0.01


def test_tendons_are_moved(real):
    model, data = loaded("""<mujoco><worldbody><light pos="0 -1 3" castshadow="false"/><site name="a" pos="0 0 1"/>
        <geom type="plane" size="1 1 .1"/><body pos=".5 0 .7"><freejoint/><geom type="box" size=".1 .1 .1"/><site name="b"/></body>
        </worldbody><tendon><spatial width=".05" rgba="1 .5 0 1"><site site="a"/><site site="b"/></spatial></tendon></mujoco>""")
    theirs, ours = real(model), drop_in.Renderer(model, **SIZE)
    made = None
    for height in (0.7, 0.4, 0.2):
        data.qpos[2] = height
        mujoco.mj_forward(model, data)
        a, b = pictures(theirs, data, -1), pictures(ours, data, -1)
        assert (a[2] != b[2]).any(axis=2).mean() < 0.002
        assert (b[2][..., 1] == mujoco.mjtObj.mjOBJ_TENDON).sum() > 50
        assert np.percentile(np.abs(a[0].astype(int) - b[0]), 95) <= 4
        made = made or ours._scene
        assert ours._scene is made


def test_numbers_of_geoms_are_read_as_one_array():
    model, data = loaded(SHAPES)
    renderer = drop_in.Renderer(model, **SIZE)
    renderer.update_scene(data)
    read = drop_in._as_one_array(renderer.scene)
    assert read is not None
    assert np.array_equal(read(renderer.scene.ngeom), drop_in._one_by_one(renderer.scene, renderer.scene.ngeom))


def test_out_and_close():
    model, data = loaded(SHAPES)
    renderer = drop_in.Renderer(model, **SIZE)
    assert (renderer.height, renderer.width) == (120, 160) and renderer.model is model
    renderer.update_scene(data)
    out = np.zeros((120, 160, 3), np.uint8)
    assert renderer.render(out=out) is out and out.any()
    with pytest.raises(ValueError, match="out.shape"):
        renderer.render(out=np.zeros((2, 2, 3), np.uint8))
    renderer.close()
    with pytest.raises(RuntimeError, match="after close"):
        renderer.render()


def test_cameras_that_are_not_there():
    model, data = loaded(SHAPES)
    renderer = drop_in.Renderer(model, **SIZE)
    with pytest.raises(ValueError, match='The camera "none" does not exist'):
        renderer.update_scene(data, "none")
    with pytest.raises(ValueError, match="out of range"):
        renderer.update_scene(data, 7)
    with pytest.raises(ValueError, match="height: 0"):
        drop_in.Renderer(model, 0, 10)


def test_an_empty_scene_is_empty():
    model, data = loaded("<mujoco/>")
    renderer = drop_in.Renderer(model, **SIZE)
    renderer.update_scene(data)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        color, depth, segments = pictures(renderer, data, -1)
    assert not color.any() and (segments == -1).all() and (depth == depth[0, 0]).all()


def test_a_skybox_is_said_to_be_left_out():
    model, data = loaded("""<mujoco><asset><texture type="skybox" builtin="flat" rgb1=".2 .4 .6" rgb2=".2 .4 .6" width="8" height="8"/></asset>
        <worldbody><geom type="sphere" size=".1"/></worldbody></mujoco>""")
    renderer = drop_in.Renderer(model, **SIZE)
    renderer.update_scene(data)
    with pytest.warns(SceneWarning, match="skybox"):
        color = renderer.render()
    assert np.abs(color[0, 0] - np.array([51, 102, 153])).max() <= 1


def test_other_names_are_mujocos():
    assert drop_in.MjModel is mujoco.MjModel and drop_in.Renderer is not mujoco.Renderer
