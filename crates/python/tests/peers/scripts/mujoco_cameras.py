"""Cameras of the model, one that follows a body, and one that turns around the scene."""
import numpy as np
from PIL import Image

import mujoco

xml = """
<mujoco>
  <visual><headlight ambient=".3 .3 .3" diffuse=".6 .6 .6"/><global azimuth="120" elevation="-20"/></visual>
  <worldbody>
    <light pos="0 0 3" directional="true" diffuse=".4 .4 .4"/>
    <camera name="fixed" pos="0 -2 1" xyaxes="1 0 0 0 .4 .9"/>
    <geom type="plane" size="0 0 .5" rgba=".5 .5 .45 1"/>
    <body name="cart" pos="0 0 .2"><joint type="slide" axis="1 0 0" name="slide"/>
      <camera name="follow" mode="trackcom" pos="0 -1.5 .6" xyaxes="1 0 0 0 .3 .95"/>
      <geom type="box" size=".3 .2 .1" rgba=".2 .5 .8 1"/>
      <geom type="cylinder" size=".1 .03" pos=".2 -.22 -.1" euler="90 0 0" rgba=".1 .1 .1 1"/>
      <geom type="cylinder" size=".1 .03" pos="-.2 -.22 -.1" euler="90 0 0" rgba=".1 .1 .1 1"/></body>
  </worldbody>
</mujoco>
"""
model = mujoco.MjModel.from_xml_string(xml)
data = mujoco.MjData(model)
renderer = mujoco.Renderer(model, 160, 200)
rows = []
for place in (0.0, 0.5):
    data.joint("slide").qpos[0] = place
    mujoco.mj_forward(model, data)
    frames = []
    for camera in ("fixed", "follow", model.camera("fixed").id, -1):
        renderer.update_scene(data, camera=camera)
        frames.append(renderer.render())
    turning = mujoco.MjvCamera()
    mujoco.mjv_defaultFreeCamera(model, turning)
    turning.distance, turning.azimuth, turning.lookat[:] = 2.0, 90 + 100 * place, (0, 0, 0.2)
    renderer.update_scene(data, turning)
    frames.append(renderer.render())
    assert np.array_equal(frames[0], frames[2])
    rows.append(np.hstack(frames))
renderer.close()
assert (rows[0] != rows[1]).any()
Image.fromarray(np.vstack(rows)).save("mujoco_cameras.png")
