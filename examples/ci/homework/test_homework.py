"""Marks a student's renderer: draws the scene with it, and fails with the report if the picture differs.

The student's program takes a scene and the name of the picture that it writes. `HALFWAY` and `STUDENT` name the two
programs where they are not `halfway` and `./student`.
"""

import os
import subprocess

HALFWAY = os.environ.get("HALFWAY", "halfway")
STUDENT = os.environ.get("STUDENT", "./student")


def test_the_picture_is_right(tmp_path):
    picture = tmp_path / "student.png"
    subprocess.run([STUDENT, "scene.json", picture], check=True)
    marked = subprocess.run(
        [HALFWAY, "mark", "scene.json", "--picture", picture, "--rubric", "rubric.json"],
        capture_output=True, text=True, encoding="utf-8", check=False,
    )
    assert marked.returncode == 0, marked.stdout + marked.stderr
