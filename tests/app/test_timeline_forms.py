"""The forms that the go-to dialog lists."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from tuisim.app.timeline import list_forms
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
