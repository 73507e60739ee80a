"""Depth and segmentation beside the colours."""
import numpy as np
from PIL import Image

import mujoco

xml = """
<mujoco>
  <worldbody>
    <light pos="0 -1 3" dir="0 .3 -1"/>
    <camera name="closeup" pos="0 -1.2 .8" xyaxes="1 0 0 0 .5 .9"/>
    <geom type="plane" size="1 1 .1" rgba=".7 .7 .7 1"/>
    <geom name="a" type="box" size=".1 .2 .1" pos="-.3 0 .1" rgba=".8 .3 .2 1"/>
    <geom name="b" type="cylinder" size=".12 .2" pos=".3 0 .2" rgba=".2 .7 .3 1"/>
    <geom name="c" type="ellipsoid" size=".1 .2 .15" pos="0 .3 .2" rgba=".3 .3 .9 1"/>
  </worldbody>
</mujoco>
"""
model = mujoco.MjModel.from_xml_string(xml)
data = mujoco.MjData(model)
mujoco.mj_forward(model, data)

with mujoco.Renderer(model) as renderer:
    renderer.update_scene(data, camera="closeup")
    color = renderer.render()

    renderer.enable_depth_rendering()
    depth = renderer.render()
    renderer.disable_depth_rendering()

    renderer.enable_segmentation_rendering()
    segments = renderer.render()
    renderer.disable_segmentation_rendering()

assert depth.dtype == np.float32 and 0.5 < depth.min() < 1.5
near = np.clip(depth - depth.min(), 0, 2)
gray = (255 * (1 - near / near.max())).astype(np.uint8)

ids, kinds = segments[..., 0], segments[..., 1]
assert set(np.unique(ids)) >= {model.geom(name).id for name in "abc"}
assert set(np.unique(kinds)) <= {-1, int(mujoco.mjtObj.mjOBJ_GEOM)}
shown = (255 * (ids + 1) / (model.ngeom + 1)).astype(np.uint8)
Image.fromarray(np.hstack([color, np.dstack([gray] * 3), np.dstack([shown] * 3)])).save("mujoco_depth.png")
