"""A model, a camera and a light: colours and depth into files."""
import numpy as np
import trimesh
from PIL import Image

import pyrender

teapot = trimesh.load("teapot.obj", force="mesh")
mesh = pyrender.Mesh.from_trimesh(teapot)
scene = pyrender.Scene()
scene.add(mesh)

camera = pyrender.PerspectiveCamera(yfov=np.pi / 3.0, aspectRatio=1.0)
low, high = scene.bounds
pose = np.eye(4)
pose[:3, 3] = scene.centroid
pose[2, 3] = high[2] + 1.2 * scene.scale / 2
scene.add(camera, pose=pose)
light = pyrender.SpotLight(color=np.ones(3), intensity=60.0, innerConeAngle=np.pi / 16.0, outerConeAngle=np.pi / 6.0)
scene.add(light, pose=pose)

renderer = pyrender.OffscreenRenderer(400, 400)
color, depth = renderer.render(scene)
renderer.delete()

assert color.shape == (400, 400, 3) and color.dtype == np.uint8
assert depth.shape == (400, 400) and depth.dtype == np.float32 and 0 < depth.max() < 100
Image.fromarray(color).save("first_color.png")
Image.fromarray((255 * depth / depth.max()).astype(np.uint8)).save("first_depth.png")
