"""The walk of a frame is counted by the modules it enters."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Iterator
from itertools import count
from pathlib import Path

import pytest

from tests.bench import frame_modules
from tests.bench.frame_modules import FrameWalks


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Every frame comes a minute after the one before; afterwards nothing is counted any more."""
    minutes = count(1)
    monkeypatch.setattr("time.monotonic", lambda: 60.0 * next(minutes))
    monkeypatch.setattr(frame_modules, "EACH_FRAME", 2)
    before = sys.getprofile()
    yield
    sys.setprofile(before)


def function_of(module: str, calls: Callable[[], object] | None = None) -> Callable[[], object]:
    """Return a function of a module, which calls another one."""
    names = {"__name__": module, "calls": calls or int}
    exec("def walk():\n    return calls()", names)
    return names["walk"]  # type: ignore[return-value]


INNER = function_of("tuisim.engine.core.geometry")
STRANGER = function_of("textual.widget", INNER)
SAME = function_of("tuisim.app.app", function_of("tuisim.app.app", STRANGER))


@pytest.mark.usefixtures("clock")
def test_a_frame_counts_one_entry_for_a_call_from_another_module(tmp_path: Path) -> None:
    walks = FrameWalks(tmp_path / "counted.json", 2)
    for _ in range(3):
        walks.drawn()
        SAME()
        INNER()
        walks.drawn()
        SAME()

    walks.drawn()
    once = {"tuisim.app.app": 1, "tuisim.engine.core.geometry": 1}
    assert json.loads((tmp_path / "counted.json").read_text()) == [once, once]
    assert sys.getprofile() is None


@pytest.mark.usefixtures("clock")
def test_a_frame_with_ten_times_the_calls_counts_ten_times_the_entries(tmp_path: Path) -> None:
    counted = []
    for times in (1, 10):
        walks = FrameWalks(tmp_path / "counted.json", 1)
        for _ in range(4):
            walks.drawn()
            for _ in range(times):
                SAME()
        counted.append(json.loads((tmp_path / "counted.json").read_text())[0])
    assert sum(counted[1].values()) == 10 * sum(counted[0].values())
