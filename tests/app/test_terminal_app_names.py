"""Nothing that a terminal would obey gets from a name in a file to the screen."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from rich.cells import cell_len
from rich.segment import Segment
from rich.style import Style
from textual.app import App
from textual.color import Color

from tests.app.app_help import settings
from tuisim.analysis.source import LogRequest
from tuisim.app.analyser.app import AnalyserApp
from tuisim.app.app import LabApp
from tuisim.app.terminal_app import Sanitize


def test_controls_are_left_out_and_nothing_moves() -> None:
    bold = Style(bold=True)
    before = [Segment("Größe 😀", bold), Segment("a\x1b[31m\x9bb\x07\n")]
    after = Sanitize().apply(before, Color(0, 0, 0))
    assert [(segment.text, segment.style) for segment in after] == [("Größe 😀", bold), ("a[31mb", None)]
    assert [cell_len(segment.text) for segment in after] == [cell_len(segment.text) for segment in before]


APPS: dict[str, Callable[[], App[None]]] = {
    "analyser": lambda: AnalyserApp(LogRequest()),
    "lab": lambda: LabApp(settings()),
}


@pytest.mark.parametrize("make", APPS.values(), ids=APPS)
async def test_all_that_is_drawn_goes_through_it(make: Callable[[], App[None]]) -> None:
    assert any(isinstance(one, Sanitize) for one in make().get_line_filters())
