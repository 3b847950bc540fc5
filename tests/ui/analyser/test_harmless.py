"""Nothing that a terminal would obey gets from a name in a file to the screen."""

from __future__ import annotations

from rich.cells import cell_len
from rich.segment import Segment
from rich.style import Style
from textual.color import Color

from tuisim.ui.analyser.app import AnalyserApp
from tuisim.ui.analyser.harmless import Harmless
from tuisim.ui.analyser.subject import Wanted


def test_controls_are_left_out_and_nothing_moves() -> None:
    bold = Style(bold=True)
    before = [Segment("Größe 😀", bold), Segment("a\x1b[31m\x9bb\x07\n")]
    after = Harmless().apply(before, Color(0, 0, 0))
    assert [(segment.text, segment.style) for segment in after] == [("Größe 😀", bold), ("a[31mb", None)]
    assert [cell_len(segment.text) for segment in after] == [cell_len(segment.text) for segment in before]


def test_all_that_the_analyser_draws_goes_through_it() -> None:
    assert any(isinstance(one, Harmless) for one in AnalyserApp(Wanted()).get_line_filters())
