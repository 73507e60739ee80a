"""Which object a pixel shows, for boxes on a table seen by a calibrated camera."""
import numpy as np
import trimesh
from PIL import Image

import pyrender

rng = np.random.default_rng(7)
scene = pyrender.Scene()
table = scene.add(pyrender.Mesh.from_trimesh(trimesh.creation.box((2.0, 2.0, 0.05)), smooth=False))
boxes = []
for _ in range(8):
    box = trimesh.creation.box(rng.uniform(0.1, 0.3, 3))
    box.visual.vertex_colors = rng.integers(60, 255, 3)
    pose = trimesh.transformations.rotation_matrix(rng.uniform(0, 3), [0, 0, 1])
    pose[:3, 3] = [*rng.uniform(-0.7, 0.7, 2), 0.15]
    boxes.append(scene.add(pyrender.Mesh.from_trimesh(box, smooth=False), pose=pose))

camera = pyrender.IntrinsicsCamera(fx=400.0, fy=400.0, cx=160.0, cy=120.0)
pose = trimesh.transformations.rotation_matrix(0.6, [1, 0, 0])
pose[:3, 3] = [0.0, -1.2, 2.0]
scene.add(camera, pose=pose)
scene.add(pyrender.DirectionalLight(color=np.ones(3), intensity=3.0), pose=pose)

r = pyrender.OffscreenRenderer(320, 240)
color, depth = r.render(scene)
colors = {node: 20 * (i + 1) for i, node in enumerate(boxes)}
segments, _ = r.render(scene, flags=pyrender.RenderFlags.SEG, seg_node_map=colors)
only_depth = r.render(scene, flags=pyrender.RenderFlags.DEPTH_ONLY)
r.delete()

found = set(np.unique(segments)) - {0}
assert found and found <= set(colors.values())
assert only_depth.shape == (240, 320) and (depth[segments[..., 0] > 0] > 0).mean() > 0.99
Image.fromarray(np.hstack([color, segments])).save("segmentation.png")
