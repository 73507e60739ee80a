"""Scripts as users of pyrender and of mujoco write them run with halfway, unchanged but for the import."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import halfway

pytest.importorskip("PIL")

HERE = Path(__file__).parent
ASSETS = HERE.parents[3] / "assets"
SCRIPTS = sorted((HERE / "scripts").glob("*.py"))


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda script: script.stem)
def test_script(script, tmp_path):
    package = script.stem.split("_")[0]
    pytest.importorskip("trimesh" if package == "pyrender" else "mujoco")
    text, count = re.subn(rf"^import {package}$", f"import halfway.{package} as {package}", script.read_text(), flags=re.M)
    assert count == 1
    for name in ("teapot.obj", "teapot.mtl", "lantern.glb"):
        shutil.copy(ASSETS / name, tmp_path)
    (tmp_path / "script.py").write_text(text)
    # Without what finds OpenGL.
    kept = {key: value for key, value in os.environ.items() if key not in ("MUJOCO_GL", "PYOPENGL_PLATFORM", "DISPLAY")}
    ran = subprocess.run([sys.executable, "script.py"], cwd=tmp_path, env=kept, capture_output=True, text=True, timeout=120)
    assert ran.returncode == 0, ran.stderr
    pictures = list(tmp_path.glob("*.png"))
    assert pictures
    for picture in pictures:
        # Something is seen.
        assert len({tuple(pixel) for pixel in halfway.open(picture).reshape(-1, 4)[::97].tolist()}) >= 3, picture.name


def test_there_are_ten():
    assert len(SCRIPTS) == 10
