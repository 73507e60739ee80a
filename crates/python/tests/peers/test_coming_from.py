"""The calls of halfway in the tables of docs/coming-from.md run on meshes of the packages that they stand for."""

import re
from pathlib import Path

import numpy as np
import pytest

import halfway

PAGE = Path(__file__).resolve().parents[4] / "docs" / "coming-from.md"


def calls(package):
    """The calls in the right column of a package's table."""
    section = PAGE.read_text(encoding="utf-8").split(f"\n## {package}\n")[1].split("\n## ")[0]
    rows = re.findall(r"^\| .* \| (.*) \|$", section, re.M)
    return [code for row in rows for code in re.findall(r"`(halfway\..*?)`", row)]


def names():
    pose = np.eye(4)
    pose[:3, 3] = 0, 0, 5
    return {"halfway": halfway, "K": [[600, 0, 320], [0, 600, 240], [0, 0, 1]], "pose": pose, "other": np.eye(4),
            "extrinsic": np.diag([1.0, -1.0, -1.0, 1.0]), "p": (3, 2, 4), "focus": (0, 0, 0), "up": (0, 1, 0)}


def run(package, given, folder, monkeypatch):
    found = calls(package)
    assert len(found) >= 8
    monkeypatch.chdir(folder)
    for call in found:
        try:
            eval(call, names() | given)  # noqa: S307
        except Exception as error:
            raise AssertionError(f"{call}: {error!r}") from error


def test_trimesh(tmp_path, monkeypatch):
    trimesh = pytest.importorskip("trimesh")
    box = trimesh.creation.box()
    run("trimesh", {"mesh": box, "scene": trimesh.Scene([box]), "a": box, "b": box}, tmp_path, monkeypatch)


def test_pyvista(tmp_path, monkeypatch):
    pyvista = pytest.importorskip("pyvista")
    sphere = pyvista.Sphere()
    sphere["heat"] = sphere.points[:, 2]
    run("pyvista", {"mesh": sphere}, tmp_path, monkeypatch)


def test_open3d(tmp_path, monkeypatch):
    try:
        import open3d
    except (ImportError, OSError) as error:
        pytest.skip(f"open3d: {error}")
    run("Open3D", {"mesh": open3d.geometry.TriangleMesh.create_box()}, tmp_path, monkeypatch)
