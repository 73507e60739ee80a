"""Pixels that are explained, and pictures that are marked."""

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


class Report(dict[str, Any]):
    """What is said of a picture that was marked: what `halfway mark --json` prints but the figures, as a dictionary.

    `text` has it in sentences, with what to look for in the program that drew the picture.
    """

    text: str

    def __init__(self, values: dict[str, Any], text: str) -> None:
        super().__init__(values)
        self.text = text

    @property
    def passes(self) -> bool:
        """Whether the picture is right."""
        return bool(self["passes"])

    @property
    def mistakes(self) -> list[str]:
        """The names of the mistakes that explain the difference best; none where nothing explains it."""
        best = self["explanations"][:1]
        return [cause[0]["name"] for explanation in best for cause in explanation["causes"]]

    def __str__(self) -> str:
        return self.text

    def __repr__(self) -> str:
        return f"<halfway report: {self['mark']:g} of {self['points']:g} points>"
