"""Presses of the brick's buttons as what the user does in a run."""

from __future__ import annotations

from collections.abc import Sequence

from tuisim.config.presses import ButtonPress
from tuisim.core.spec import BUTTONS
from tuisim.protocol import SetButtons, UserAction


def press_actions(presses: Sequence[ButtonPress], tick_hz: int) -> tuple[UserAction, ...]:
    """Return the changes of the button states, ordered by tick; presses may overlap, and last at least one tick."""
    held = []
    for press in presses:
        first = round(press.from_s * tick_hz)
        held.append((press.button, first, max(first + 1, round(press.until_s * tick_hz))))
    changes: list[UserAction] = []
    before: tuple[str, ...] = ()
    for tick in sorted({tick for _, first, last in held for tick in (first, last)}):
        down = {button for button, first, last in held if first <= tick < last}
        pressed = tuple(button for button in BUTTONS if button in down)
        if pressed != before:
            changes.append(UserAction(tick, SetButtons(pressed)))
            before = pressed
    return tuple(changes)
