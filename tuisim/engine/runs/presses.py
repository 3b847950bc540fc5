"""What a hand presses in a run, as user actions."""

from __future__ import annotations

from collections.abc import Iterable

from tuisim.engine.core.spec import PRESSABLE
from tuisim.engine.presses import parse_press
from tuisim.engine.protocol import SetButtons, UserAction


def press_actions(presses: Iterable[str], tick_hz: int) -> tuple[UserAction, ...]:
    """Return the user actions that press and release what a hand presses, ordered by tick.

    Args:
        presses: As texts, see `parse_press`; they may overlap, and each lasts at least one tick.
    """
    held = []
    for press in map(parse_press, presses):
        first = round(press.from_s * tick_hz)
        held.append((press.name, first, max(first + 1, round(press.until_s * tick_hz))))
    changes: list[UserAction] = []
    before: tuple[str, ...] = ()
    for tick in sorted({tick for _, first, last in held for tick in (first, last)}):
        down = {name for name, first, last in held if first <= tick < last}
        pressed = tuple(name for name in PRESSABLE if name in down)
        if pressed != before:
            changes.append(UserAction(tick, SetButtons(pressed)))
            before = pressed
    return tuple(changes)
