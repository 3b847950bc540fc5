"""What is held from which tick."""

from __future__ import annotations

from tests.cases import cases
from tuisim.engine.protocol import SetButtons, UserAction
from tuisim.settings.presses import press_actions

HELD = {
    "none": ((), ()),
    "one": (("enter@1",), ((100, ("enter",)), (110, ()))),
    "shorter than a tick": (("enter@1-1.001",), ((100, ("enter",)), (101, ()))),
    "overlapping": (
        ("enter@1-3", "up@2-4"),
        ((100, ("enter",)), (200, ("up", "enter")), (300, ("up",)), (400, ())),
    ),
    "the same one": (("up@1-2", "up@1.5-3"), ((100, ("up",)), (300, ()))),
    "one after the other": (("up@1-2", "down@2-3"), ((100, ("up",)), (200, ("down",)), (300, ()))),
    "not in order": (("up@5", "down@1"), ((100, ("down",)), (110, ()), (500, ("up",)), (510, ()))),
}


@cases("texts, changes", HELD)
def test_planned_presses_become_button_changes_at_their_ticks(
    texts: tuple[str, ...], changes: tuple[tuple[int, tuple[str, ...]], ...]
) -> None:
    found = press_actions(texts, 100)
    assert found == tuple(UserAction(tick, SetButtons(pressed)) for tick, pressed in changes)


def test_planned_presses_happen_at_ticks_of_the_profile() -> None:
    assert [change.tick for change in press_actions(["up@1-2"], 30)] == [30, 60]
