"""A scene whose parts move: a wheel on an arm, drawn at several times."""
import numpy as np
import trimesh
from PIL import Image

import pyrender

scene = pyrender.Scene(ambient_light=np.array([0.2, 0.2, 0.2, 1.0]), bg_color=np.zeros(4))
arm = pyrender.Node(name="arm", mesh=pyrender.Mesh.from_trimesh(trimesh.creation.box((1.2, 0.1, 0.1)), smooth=False),
                    matrix=np.eye(4))
wheel = pyrender.Node(name="wheel", translation=np.array([0.6, 0.0, 0.1]),
                      mesh=pyrender.Mesh.from_trimesh(trimesh.creation.cylinder(0.25, 0.08, sections=8), smooth=False))
scene.add_node(arm)
scene.add_node(wheel, parent_node=arm)
camera = pyrender.Node(camera=pyrender.OrthographicCamera(xmag=1.2, ymag=1.2), translation=[0.0, 0.0, 3.0])
scene.add_node(camera)
scene.add(pyrender.DirectionalLight(intensity=4.0), pose=trimesh.transformations.rotation_matrix(-0.5, [1, 1, 0]))

r = pyrender.OffscreenRenderer(160, 160)
frames = []
for angle in np.linspace(0, 1.5, 4):
    scene.set_pose(arm, trimesh.transformations.rotation_matrix(angle, [0, 0, 1]))
    color, _ = r.render(scene, pyrender.RenderFlags.SKIP_CULL_FACES)
    frames.append(color)
scene.remove_node(wheel)
frames.append(r.render(scene)[0])
r.delete()
assert all((a != b).any() for a, b in zip(frames, frames[1:])) and not scene.has_node(wheel)
Image.fromarray(np.hstack(frames)).save("moving.png")
