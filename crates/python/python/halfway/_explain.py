"""Pixels, explained."""

from __future__ import annotations

from typing import Any


class Explanation(dict[str, Any]):
    """How a pixel came to its colour: what `halfway explain --json` prints, as a dictionary.

    `text` has it as lines to read, `latex` as `align*` blocks. In a notebook they are typeset.
    """

    text: str
    latex: str

    def __init__(self, values: dict[str, Any], text: str, latex: str) -> None:
        super().__init__(values)
        self.text, self.latex = text, latex

    @property
    def color(self) -> tuple[float, float, float]:
        """The linear intensities of the pixel."""
        r, g, b = self["color"]
        return r, g, b

    @property
    def bytes(self) -> tuple[int, int, int]:
        """The bytes of the pixel."""
        r, g, b = self["bytes"]
        return r, g, b

    def __str__(self) -> str:
        return self.text

    def __repr__(self) -> str:
        return f"<halfway explanation of pixel {tuple(self['pixel'])}: {self.bytes}>"

    def _repr_latex_(self) -> str:
        return self.latex
