"""The forms that the go-to dialog lists."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from tuisim.app.timeline import Timeline, _left, forms, proposal


@pytest.mark.parametrize("tick, which", [(3, "the next"), (10, "the first")], ids=["past", "end"])
def test_they_say_in_which_direction_the_search_goes(tick: int, which: str) -> None:
    timeline: Any = SimpleNamespace(tick=tick, newest=10)

    assert all(
        which in meaning
        for form, meaning in forms(timeline)
        if form.startswith(("line", "sample", "print"))
    )


def test_nothing_is_proposed_before_the_first_run() -> None:
    assert proposal(Timeline(), None) == ""


def test_the_reading_is_followed_to_half_way_between_before_and_now() -> None:
    values = np.array([80.0, 80, 10, 10, 30, 60, 80, 80])
    comparison, became = _left(values, np.ones(8, bool), 5)
    assert (comparison, [*became]) == ("> 45", [5])


def test_two_greys_that_are_nearly_the_same_are_told_by_the_change() -> None:
    comparison, became = _left(np.array([50.0, 50, 50.2]), np.ones(3, bool), 1)
    assert (comparison, [*became]) == ("changes", [2])


def test_what_was_seen_beside_the_mat_is_no_middle() -> None:
    values, is_on = np.array([0.0, 100, 60, 60, 100]), np.array([False, True, True, True, True])
    assert _left(values, is_on, 3)[0] == "> 80"
