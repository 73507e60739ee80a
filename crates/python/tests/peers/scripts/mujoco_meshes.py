"""A mesh from arrays, a height field, materials, and arrows that are drawn over the scene."""
import numpy as np
from PIL import Image

import mujoco

xml = """
<mujoco>
  <asset>
    <mesh name="roof" vertex="-.3 -.3 0 .3 -.3 0 .3 .3 0 -.3 .3 0 0 0 .4"/>
    <hfield name="hills" nrow="30" ncol="30" size="1 1 .2 .05"/>
    <material name="polished" rgba=".8 .6 .3 1" specular="1" shininess=".9"/>
  </asset>
  <worldbody>
    <light pos="0 -2 3" dir="0 .6 -1"/>
    <geom type="hfield" hfield="hills" rgba=".4 .6 .3 1"/>
    <geom type="mesh" mesh="roof" pos="0 0 .4" material="polished"/>
  </worldbody>
</mujoco>
"""
model = mujoco.MjModel.from_xml_string(xml)
y, x = np.mgrid[0:30, 0:30] / 29.0
model.hfield_data[:] = (0.5 + 0.5 * np.sin(9 * x) * np.sin(7 * y)).ravel()
data = mujoco.MjData(model)
mujoco.mj_forward(model, data)

renderer = mujoco.Renderer(model, width=320, height=240)
renderer.update_scene(data)
plain = renderer.render().copy()
scene = renderer.scene
for start, end, color in (((0, 0, 1.0), (0.5, 0, 1.2), (1, 0, 0, 1)), ((0, 0, 1.0), (0, 0, 1.5), (0, 0, 1, 1))):
    geom = scene.geoms[scene.ngeom]
    mujoco.mjv_initGeom(geom, mujoco.mjtGeom.mjGEOM_ARROW, np.zeros(3), np.zeros(3), np.zeros(9), np.float32(color))
    mujoco.mjv_connector(geom, mujoco.mjtGeom.mjGEOM_ARROW, 0.03, np.array(start, float), np.array(end, float))
    scene.ngeom += 1
out = np.empty((240, 320, 3), np.uint8)
renderer.render(out=out)
assert (plain != out).any()
Image.fromarray(np.hstack([plain, out])).save("mujoco_meshes.png")
