"""A small model as text: a picture of it, and geoms of other colours."""
import numpy as np
from PIL import Image

import mujoco

xml = """
<mujoco>
  <worldbody>
    <light name="top" pos="0 0 1"/>
    <body name="box_and_sphere" euler="0 0 -30">
      <joint name="swing" type="hinge" axis="1 -1 0" pos="-.2 -.2 -.2"/>
      <geom name="red_box" type="box" size=".2 .2 .2" rgba="1 0 0 1"/>
      <geom name="green_sphere" pos=".2 .2 .2" size=".1" rgba="0 1 0 1"/>
    </body>
  </worldbody>
</mujoco>
"""
model = mujoco.MjModel.from_xml_string(xml)
data = mujoco.MjData(model)
with mujoco.Renderer(model) as renderer:
    mujoco.mj_forward(model, data)
    renderer.update_scene(data)
    first = renderer.render()
    model.geom("red_box").rgba[:3] = 0.2, 0.4, 0.9
    renderer.update_scene(data)
    second = renderer.render()

assert first.shape == (240, 320, 3) and first.dtype == np.uint8 and (first != second).any()
Image.fromarray(np.hstack([first, second])).save("mujoco_first.png")
