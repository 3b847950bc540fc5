"""Nothing that a terminal would obey gets from a name in a file to the screen."""

from __future__ import annotations

from collections.abc import Callable

from textual.app import App

from tests.app.app_help import settings
from tests.cases import cases
from tuisim.analysis.source import LogRequest
from tuisim.app.analyser.app import AnalyserApp
from tuisim.app.app import LabApp
from tuisim.terminal.app import Sanitize

APPS: dict[str, Callable[[], App[None]]] = {
    "analyser": lambda: AnalyserApp(LogRequest()),
    "lab": lambda: LabApp(settings()),
}


@cases("make", APPS)
async def test_every_app_filters_drawn_lines_through_the_sanitizer(
    make: Callable[[], App[None]],
) -> None:
    assert any(isinstance(one, Sanitize) for one in make().get_line_filters())
