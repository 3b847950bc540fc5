"""The words of the debug panel where there is little to say, or little room."""

from __future__ import annotations

import pytest

from tests.cases import for_each
from tuisim.app.render.debug import DebugView, debug_lines
from tuisim.app.snapshot import RunPhase
from tuisim.engine.protocol import FrameState, Inspected, Paused, PauseReason, Variable


def text(view: DebugView, width: int) -> list[str]:
    return ["".join(part for part, _ in line) for line in debug_lines(view, width)]


@for_each(width=[26, 38], state=list(RunPhase))
def test_the_debug_panel_names_all_its_keys_also_when_narrow(state: RunPhase, width: int) -> None:
    narrow = text(DebugView(state), width)
    wide = text(DebugView(state), 80)
    assert max(map(len, narrow)) <= width
    assert " ".join(narrow).split() == " ".join(wide).split()


def test_a_program_that_runs_is_not_said_not_to_have_started() -> None:
    without = [state for state in RunPhase if "not started" not in text(DebugView(state), 80)[0]]
    assert without == [state for state in RunPhase if state is not RunPhase.IDLE]


def test_the_debug_panel_shows_the_time_looked_at_until_its_variables_arrive() -> None:
    looked = Inspected(
        469, 4_690_000_000, "main", 0, "", (), (FrameState("<module>", 13, ""),), (), (), ()
    )
    view = DebugView(
        RunPhase.ENDED,
        Paused(469, 4_690_000_000, 13, PauseReason.INSTANT),
        looked,
        True,
        now=(120, 1.2),
    )
    rows = text(view, 40)
    assert rows[0] == "1.20 s · tick 120 …"
    assert not any("4.69" in row or "line 13" in row for row in rows)


def test_why_a_condition_holds_is_told_whole() -> None:
    why = "cannot be evaluated: TypeError: '>' not supported between instances of 'str' and 'int'"
    looked = Inspected(
        5, 50_000_000, "main", 0, "", (), (FrameState("<module>", 3, ""),), (), (), ()
    )
    paused = Paused(5, 50_000_000, 3, PauseReason.BREAK, "3 if name > 3", value=why)
    rows = text(DebugView(RunPhase.PAUSED, paused, looked), 30)
    assert f"break 3 if name > 3: {why}" in " ".join(rows)
    assert max(map(len, rows)) <= 30


@pytest.mark.parametrize("changed", ["left", "right"])
def test_the_debug_panel_lists_variables_in_order_and_constants_last(changed: str) -> None:
    kinds = {"sleep": "builtin_function_or_method", "SPEED": "int", "left": "int", "right": "int"}
    variables = tuple(Variable(name, kind, "1", name == changed) for name, kind in kinds.items())
    looked = Inspected(
        5, 50_000_000, "main", 0, "", (), (FrameState("<module>", 3, ""),), variables, (), ()
    )
    rows = text(DebugView(RunPhase.PAUSED, Paused(5, 50_000_000, 3, PauseReason.STEP), looked), 30)
    shown = [row[2:].split()[0] for row in rows[rows.index("Variables") + 1 :]]
    assert shown == ["left", "right", "SPEED", "sleep"]


@pytest.mark.parametrize(
    "width, past, head",
    [
        (26, False, "line 13 · 4.69 s"),
        (27, False, "line 13 · 4.69 s · tick 469"),
        (26, True, "line 13 · 4.69 s past"),
        (40, True, "line 13 · 4.69 s · tick 469 past"),
    ],
    ids=["narrow", "enough", "narrow past", "wide past"],
)
def test_the_debug_panel_shows_the_tick_number_whole_or_not_at_all(
    width: int, past: bool, head: str
) -> None:
    looked = Inspected(
        469, 4_690_000_000, "main", 0, "", (), (FrameState("<module>", 13, ""),), (), (), ()
    )
    view = DebugView(
        RunPhase.PAUSED, Paused(469, 4_690_000_000, 13, PauseReason.STEP), looked, past
    )
    assert text(view, width)[0] == head
