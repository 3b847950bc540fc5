"""The forms that the go-to dialog lists."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from tuisim.app.timeline import list_forms


@pytest.mark.parametrize("tick, which", [(3, "the next"), (10, "the first")], ids=["past", "end"])
def test_they_say_in_which_direction_the_search_goes(tick: int, which: str) -> None:
    timeline: Any = SimpleNamespace(tick=tick, newest=10)

    assert all(
        which in meaning
        for form, meaning in list_forms(timeline)
        if form.startswith(("line", "sample", "print"))
    )
