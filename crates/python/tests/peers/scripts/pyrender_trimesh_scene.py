"""A whole scene of trimesh from a file, seen from all sides, and copies of one mesh by poses."""
import numpy as np
import trimesh
from PIL import Image

import pyrender

loaded = trimesh.load("lantern.glb")
scene = pyrender.Scene.from_trimesh_scene(loaded, bg_color=[1.0, 1.0, 1.0], ambient_light=[0.3, 0.3, 0.3])

steps = np.tile(np.eye(4), (5, 1, 1))
steps[:, 0, 3] = np.linspace(-1, 1, 5) * scene.scale / 3
steps[:, 1, 3] = scene.bounds[0, 1]
ball = trimesh.creation.uv_sphere(radius=scene.scale / 40)
ball.visual.vertex_colors = [200, 40, 40]
scene.add(pyrender.Mesh.from_trimesh(ball, poses=steps))

node = scene.add(pyrender.PerspectiveCamera(yfov=0.7, znear=scene.scale / 100, zfar=scene.scale * 10))
scene.add(pyrender.DirectionalLight(intensity=5.0), parent_node=node)
r = pyrender.OffscreenRenderer(240, 240)
views = []
for angle in (0.0, np.pi / 2, np.pi):
    pose = trimesh.transformations.rotation_matrix(angle, [0, 1, 0])
    pose[:3, 3] = scene.centroid + pose[:3, 2] * 1.5 * scene.scale
    scene.set_pose(node, pose)
    color, depth = r.render(scene)
    assert (depth > 0).mean() > 0.02
    views.append(color)
r.delete()
Image.fromarray(np.hstack(views)).save("trimesh_scene.png")
