"""Pictures of meshes on the CPU: flat, Gouraud and Phong shading, without a GPU, a driver or a display.

    import halfway

    picture = halfway.render(vertices, faces)
    picture.save("mesh.png")
"""

from . import equations
from ._arguments import Options
from ._halfway import OPTIONS, OUTPUTS, PRESETS, __version__
from ._explain import Explanation, Report
from ._golden import check
from ._mesh import Mesh
from ._parts import Camera, DirectionalLight, HemisphereLight, Light, Material, PointLight, SpotLight
from ._picture import Comparison, Picture, compare, save_animation
from ._picture import open_picture as open
from ._render import animate, explain, mark, reference, render, sheet, turntable, verify
from ._scene import Scene, SceneCamera, SceneLight, SceneObject, SceneWarning
from .equations import blinn_phong, phong

__all__ = [
    "OPTIONS", "OUTPUTS", "PRESETS", "Camera", "Comparison", "DirectionalLight", "Explanation", "HemisphereLight", "Light",
    "Material", "Mesh", "Options", "Picture", "PointLight", "Report", "Scene", "SceneCamera", "SceneLight", "SceneObject",
    "SceneWarning", "SpotLight", "__version__", "animate", "blinn_phong", "check", "compare", "equations", "explain", "mark",
    "open", "phong", "reference", "render", "save_animation", "sheet", "turntable", "verify",
]
