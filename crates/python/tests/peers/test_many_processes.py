"""Pictures by the workers of Dask and of Ray have the bytes of those by one process."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import halfway

EXAMPLES = Path(__file__).resolve().parents[4] / "examples" / "python"


def ran(example, *arguments):
    environment = {**os.environ, "RAY_worker_niceness": "0"}
    done = subprocess.run([sys.executable, EXAMPLES / example, "--size", "48", "--views", "6", *arguments],
                          env=environment, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_dask(tmp_path):
    pytest.importorskip("distributed")
    said = ran("dask_turntable.py", "--output", str(tmp_path / "all.png"))
    assert "Dask, two processes: 60 pictures of 48 x 48" in said and "all bytes are equal" in said
    assert halfway.open(tmp_path / "all.png").shape == (480, 288, 4)


def test_ray(tmp_path):
    pytest.importorskip("ray")
    np = pytest.importorskip("numpy")
    said = ran("ray_dataset.py", "--output", str(tmp_path / "all.npz"))
    assert "Ray, two processes: 60 rows of 48 x 48" in said and "all bytes are equal" in said
    rows = np.load(tmp_path / "all.npz")
    assert rows["image"].shape == (60, 48, 48, 3) and rows["mask"].any(axis=(1, 2)).all()
