"""The recipes of docs/python.md: each runs, and its picture is the one that the page shows."""

import re
from pathlib import Path


import halfway
from conftest import ROOT

PAGE = ROOT / "docs/python.md"
PICTURES = ROOT / "docs/pictures/python"


def run(folder: Path):
    """Runs all recipes of the page, one after the other, in this folder."""
    (folder / "assets").symlink_to(ROOT / "assets")
    names = {}
    for recipe in re.findall(r"```python\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.S):
        exec(compile(recipe, str(PAGE), "exec"), names)  # noqa: S102


def test_the_recipes_draw_what_the_page_shows(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    run(tmp_path)
    shown = re.findall(r"\(pictures/python/(.*?)\)", PAGE.read_text(encoding="utf-8"))
    assert len(shown) >= 9
    for name in shown:
        assert (halfway.open(tmp_path / name) == halfway.open(PICTURES / name)).all(), name


if __name__ == "__main__":
    # Makes the pictures of the page again.
    import os
    import shutil
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        run(Path(folder))
        PICTURES.mkdir(parents=True, exist_ok=True)
        for name in re.findall(r"\(pictures/python/(.*?)\)", PAGE.read_text(encoding="utf-8")):
            shutil.copy(name, PICTURES / name)
