"""README: its length, its fences, and its picture."""

from __future__ import annotations

from xml.etree import ElementTree

import pytest

from tests.conftest import ROOT
from tests.guide.documents import DOCUMENTS, blocks
from tests.guide.picture import PICTURE, drawn

SVG = "{http://www.w3.org/2000/svg}"
MAX_LINES = 160
START = "python3 -m venv .venv && .venv/bin/pip install -q -e"


def test_readme_is_short() -> None:
    assert DOCUMENTS["README"].count("\n") <= MAX_LINES


def test_readme_has_the_two_commands_for_a_clone() -> None:
    marked = {
        block.kind: block.code for block in blocks("README") if block.kind in ("sh run", "sh test")
    }
    assert marked == {
        "sh run": f"{START} . && .venv/bin/tuisim programs/log_greys.py\n",
        "sh test": f"{START} '.[test]' && .venv/bin/python -m pytest -q\n",
    }


def test_the_picture_is_a_drawing_that_loads_nothing() -> None:
    assert f"({PICTURE.relative_to(ROOT)})" in DOCUMENTS["README"]
    root = ElementTree.parse(PICTURE).getroot()
    assert root.tag == f"{SVG}svg"
    tags = {node.tag.removeprefix(SVG) for node in root.iter()}
    assert tags & {"script", "image", "foreignObject", "use"} == set()
    values = [value for node in root.iter() for key, value in node.attrib.items()] + [
        node.text or "" for node in root.iter()
    ]
    assert [value for value in values if "://" in value or "url(" in value] == []
    words = "".join("".join(node.itertext()) for node in root.iter(f"{SVG}text")).replace(" ", "")
    assert [
        panel
        for panel in ("World", "Instrumentation", "Chart", "log_greys.py", "past3.41s")
        if panel not in words
    ] == []


@pytest.mark.slow
async def test_the_script_draws_the_picture(home: object, monkeypatch: pytest.MonkeyPatch) -> None:
    """After a change of the app's look: `python -m tests.guide.picture`."""
    monkeypatch.setenv("COLORTERM", "truecolor")
    assert await drawn() == PICTURE.read_text(encoding="utf-8")
