"""The same bits everywhere: twenty pictures with the hashes that they have on every machine."""

import hashlib
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import halfway

ROOT = Path(__file__).resolve().parents[3]
HASHES = Path(__file__).with_name("hashes.json")


def pictures():
    """The pictures by their names."""
    scenes = sorted((ROOT / "examples/scenes").glob("*.json"))
    for scene in scenes:
        if scene.stem != "four_views":
            yield scene.stem, lambda scene=scene: halfway.Scene(scene).render(size=(160, 120))
    crate, lantern = ROOT / "assets/crate.obj", ROOT / "assets/lantern.glb"
    yield "crate", lambda: halfway.render(crate, size=(160, 120), samples=16)
    yield "crate flat", lambda: halfway.render(crate, size=(160, 120), shading="flat", reflectance="phong")
    yield "crate gouraud", lambda: halfway.render(crate, size=(160, 120), shading="gouraud", edges="feature")
    yield "lantern", lambda: halfway.render(lantern, size=(160, 120), view="iso", ortho=True)
    yield "lantern floats", lambda: halfway.render(lantern, size=(160, 120), floats=True, intensity="reinhard")
    yield "lantern depth", lambda: halfway.render(lantern, size=(160, 120), outputs=["depth"])["depth"]
    yield "lantern normals", lambda: halfway.render(lantern, size=(160, 120), outputs=["normal"])["normal"]
    yield "lantern ids", lambda: halfway.render(lantern, size=(160, 120), outputs=["triangle"])["triangle"]
    yield "rod", lambda: halfway.render(ROOT / "assets/warm_rod.ply", size=(160, 120), background="white..navy")


def hashes():
    """The hash of each picture."""
    return {name: hashlib.sha256(np.ascontiguousarray(draw()).tobytes()).hexdigest()[:16] for name, draw in pictures()}


@pytest.mark.parametrize("adapter", ["cpu", "cpu:avx512", "cpu:avx2", "cpu:neon", "cpu:plain"])
def test_hashes(adapter):
    program = "import json, test_same_bits; print(json.dumps(test_same_bits.hashes()))"
    environment = os.environ | {"HALFWAY_ADAPTER": adapter, "PYTHONPATH": os.pathsep.join(map(os.path.abspath, sys.path))}
    ran = subprocess.run([sys.executable, "-W", "ignore", "-c", program], cwd=Path(__file__).parent, env=environment,
                         capture_output=True, text=True, check=False)
    if ran.returncode and "this CPU cannot draw" in ran.stderr:
        pytest.skip(f"{adapter}: not on this processor")
    assert ran.returncode == 0, ran.stderr
    found = json.loads(ran.stdout)
    assert len(found) >= 20
    assert found == json.loads(HASHES.read_text()), "to write them anew: python tests/test_same_bits.py"


if __name__ == "__main__":
    HASHES.write_text(json.dumps(hashes(), indent=1) + "\n")
