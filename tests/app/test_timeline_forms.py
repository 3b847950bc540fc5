"""The forms that the go-to dialog lists."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from tuisim.app.timeline import Timeline, describe_match, find, list_forms
from tuisim.engine.runs.records import OutputRow, Stream


@pytest.mark.parametrize("tick, which", [(3, "the next"), (10, "the first")], ids=["past", "end"])
def test_examples_in_the_go_to_dialog_say_in_which_direction_they_search(
    tick: int, which: str
) -> None:
    timeline: Any = SimpleNamespace(tick=tick, newest=10, recording=None)

    assert all(
        which in meaning
        for form, meaning in list_forms(timeline)
        if form.startswith(("line", "sample", "print"))
    )


def test_examples_in_the_go_to_dialog_name_a_printed_sample() -> None:
    printed = [OutputRow(text, 0, 0, 1, Stream.STDOUT) for text in ("no sample", "Way: 3")]
    recording = SimpleNamespace(rows=SimpleNamespace(rows=lambda _: printed))
    timeline: Any = SimpleNamespace(tick=0, newest=10, recording=recording)

    forms = [form for form, _ in list_forms(timeline)]
    assert "sample Way" in forms and "Way < 90" in forms


class Printed:
    """Rows of a run that printed `Way: 1` at ticks 2, 5 and 9."""

    printed = tuple(
        OutputRow("Way: 1", tick, number, 1, Stream.STDOUT) for number, tick in enumerate((2, 5, 9))
    )

    def rows(self, first: int) -> list[OutputRow]:
        return [*self.printed[first:]]

    def until(self, tick: int) -> int:
        return sum(row.tick <= tick for row in self.printed)


@pytest.mark.parametrize(
    "start, text, words",
    [
        (0, "sample Way", ""),
        (3, "sample Way", "`sample Way first` goes to 0.02 s"),
        (3, "sample Way first", ""),
        (
            6,
            "print Way",
            "print Way: the latest instant, 0.09 s · `print Way first` goes to 0.02 s",
        ),
        (3, "end", ""),
        (3, "0.09", ""),
        (3, "tick 9", "tick 9: the latest instant, 0.09 s"),
    ],
)
def test_a_search_that_finds_a_later_match_says_where_the_first_is(
    start: int, text: str, words: str
) -> None:
    spec = SimpleNamespace(profile=SimpleNamespace(tick_hz=100))
    recording: Any = SimpleNamespace(rows=Printed(), newest=9, spec=spec)
    timeline = Timeline()
    timeline.recording, timeline.at = recording, start

    tick = find(text, timeline, first_at_end=True)

    assert describe_match(text, tick, timeline) == words
