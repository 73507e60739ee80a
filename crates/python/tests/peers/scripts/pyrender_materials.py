"""Spheres of several materials in a row, under three lights."""
import numpy as np
import trimesh
from PIL import Image

import pyrender

scene = pyrender.Scene(bg_color=[0.1, 0.1, 0.15, 1.0], ambient_light=[0.05, 0.05, 0.05])
ball = trimesh.creation.icosphere(subdivisions=4, radius=0.45)
for i, roughness in enumerate([0.2, 0.4, 0.6, 0.8]):
    for j, metallic in enumerate([0.0, 0.9]):
        material = pyrender.MetallicRoughnessMaterial(
            baseColorFactor=[0.9, 0.6, 0.2, 1.0], metallicFactor=metallic, roughnessFactor=roughness)
        pose = np.eye(4)
        pose[:3, 3] = [i - 1.5, j - 0.5, 0.0]
        scene.add(pyrender.Mesh.from_trimesh(ball, material=material), name=f"ball {i} {j}", pose=pose)

camera_pose = np.eye(4)
camera_pose[:3, 3] = [0.0, 0.0, 5.0]
camera = scene.add(pyrender.PerspectiveCamera(yfov=np.pi / 6.0), pose=camera_pose)
for angle in (0.0, 2.1, 4.2):
    pose = np.eye(4)
    pose[:3, 3] = [3 * np.cos(angle), 3 * np.sin(angle), 3.0]
    scene.add(pyrender.PointLight(color=[1.0, 1.0, 1.0], intensity=12.0), pose=pose)
scene.add(pyrender.DirectionalLight(color=[0.8, 0.9, 1.0], intensity=1.0), parent_node=camera)

r = pyrender.OffscreenRenderer(viewport_width=640, viewport_height=320)
color, _ = r.render(scene, flags=pyrender.RenderFlags.RGBA)
r.delete()
assert color.shape == (320, 640, 4) and len(scene.get_nodes(name="ball 2 1")) == 1
Image.fromarray(color).save("materials.png")
