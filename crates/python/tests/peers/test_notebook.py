"""The notebook with sliders runs, and shows a picture for each of its two functions."""

from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[4]


def test_the_lecture():
    nbformat, nbclient = pytest.importorskip("nbformat"), pytest.importorskip("nbclient")
    pytest.importorskip("ipywidgets")
    notebook = nbformat.read(ROOT / "examples/python/lecture.ipynb", as_version=4)
    nbclient.NotebookClient(notebook, timeout=60).execute()
    views = [output for cell in notebook.cells if cell.cell_type == "code" for output in cell.outputs]
    widgets = [view for view in views if "application/vnd.jupyter.widget-view+json" in view.get("data", {})]
    assert len(widgets) == 2
    state = notebook.metadata.widgets["application/vnd.jupyter.widget-state+json"]["state"].values()
    shown = [output for widget in state for output in widget["state"].get("outputs", [])]
    assert sum("image/png" in output.get("data", {}) for output in shown) == 2
