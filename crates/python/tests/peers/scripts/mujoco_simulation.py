"""A simulation of two seconds, drawn thirty times a second, with joints shown."""
import numpy as np
from PIL import Image

import mujoco

xml = """
<mujoco>
  <option gravity="0 0 -9.81"/>
  <asset>
    <texture name="grid" type="2d" builtin="checker" rgb1=".1 .2 .3" rgb2=".2 .3 .4" width="300" height="300"/>
    <material name="grid" texture="grid" texrepeat="8 8" reflectance=".2"/>
  </asset>
  <worldbody>
    <light pos="0 0 2" diffuse=".8 .8 .8"/>
    <geom name="floor" type="plane" size="1 1 .01" material="grid"/>
    <body name="ball" pos="0 0 .6"><freejoint/><geom type="sphere" size=".08" rgba=".9 .5 .1 1"/></body>
    <body name="stick" pos=".3 0 .7"><joint type="hinge" axis="0 1 0"/>
      <geom type="capsule" fromto="0 0 0 .3 0 0" size=".03" rgba=".2 .6 .9 1"/></body>
  </worldbody>
</mujoco>
"""
model = mujoco.MjModel.from_xml_string(xml)
data = mujoco.MjData(model)
scene_option = mujoco.MjvOption()
scene_option.flags[mujoco.mjtVisFlag.mjVIS_JOINT] = True

frames = []
mujoco.mj_resetData(model, data)
with mujoco.Renderer(model, height=120, width=160) as renderer:
    while data.time < 2.0:
        mujoco.mj_step(model, data)
        if len(frames) < data.time * 30:
            renderer.update_scene(data, scene_option=scene_option)
            frames.append(renderer.render())

assert 59 <= len(frames) <= 61 and (frames[0] != frames[20]).any()
Image.fromarray(np.hstack(frames[::15])).save("mujoco_simulation.png")
