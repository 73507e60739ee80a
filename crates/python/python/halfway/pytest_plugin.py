"""The pytest plugin: a fixture `picture` that compares pictures with stored ones.

    def test_part(picture):
        picture.check(halfway.render("part.stl"))

Of a module `test_parts.py` the golden picture of this test is `pictures/test_parts/test_part.png` beside the module;
`pytest --update-pictures` writes it.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from collections.abc import Iterator

FOLDER = "halfway_pictures"


class PictureFixture:
    """Compares pictures with the golden ones of a test."""

    def __init__(self, folder: Path, name: str, failures: Path, update: bool) -> None:
        self.folder = folder
        """The folder of the golden pictures: `pictures/MODULE` beside the test module."""
        self._name, self._failures, self._update = name, failures, update
        self._checked: set[str] = set()

    def check(self, picture: Any, name: str | None = None, *, max_steps: int = 0, equal: float | None = None) -> None:
        """Asserts that a picture is the golden one, as `halfway.check` does. The file is named for the test; where a test
        checks several pictures, `name` tells them apart."""
        __tracebackhide__ = True
        from ._golden import check

        file = f"{self._name}-{_plain(name)}.png" if name else f"{self._name}.png"
        if file in self._checked:
            raise ValueError(f"picture.check: {file} was checked before in this test; expected another name for each "
                             "picture")
        self._checked.add(file)
        check(picture, self.folder / file, max_steps=max_steps, equal=equal, folder=self._failures, update=self._update)


def _plain(name: str) -> str:
    return re.sub(r"[^\w.-]+", "_", name).strip("_")


def pytest_addoption(parser: pytest.Parser) -> None:
    group = parser.getgroup("halfway", "pictures of halfway")
    group.addoption("--update-pictures", action="store_true", help="store pictures in place of comparing them")
    group.addoption("--pictures-folder", metavar="FOLDER",
                    help="where pictures that differ are written (default: halfway-pictures)")
    parser.addini(FOLDER, "where pictures that differ are written", default="halfway-pictures")


@pytest.fixture
def picture(request: pytest.FixtureRequest) -> Iterator[PictureFixture]:
    """Compares pictures with the golden ones of this test: `picture.check(image)`."""
    config = request.config
    failures = config.rootpath / (config.getoption("--pictures-folder") or config.getini(FOLDER))
    owner = f"{request.cls.__name__}-" if request.cls is not None else ""
    name = _plain(owner + request.node.name)
    # Modules may have tests of the same name.
    module = request.path.stem
    yield PictureFixture(request.path.parent / "pictures" / module, name, failures / module,
                         config.getoption("--update-pictures"))
