"""What was pressed by hand in a run: buttons, the remote and touch sensors."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from tuisim.base.data_class import dataclass
from tuisim.engine.core.spec import TOUCH
from tuisim.engine.protocol import SetButtons, UserAction


@dataclass(frozen=True, slots=True)
class HandPress:
    """A press of one button or touch sensor by hand, with its start and end in simulated seconds."""

    name: str
    """One of `PRESSABLE`."""
    from_s: float
    until_s: float


def find_presses(
    actions: Iterable[UserAction], names: Sequence[str], hz: int, ticks: int
) -> tuple[HandPress, ...]:
    """Return when buttons and touch sensors were pressed by hand, in the order in which the presses end.

    Args:
        actions: The user's actions in a run.
        names: The names of the buttons and sensors to consider, from `PRESSABLE`.
        hz: Ticks per second.
        ticks: Length of the run in ticks; a press that goes on at the end ends there.
    """
    since: dict[str, int] = {}
    presses: list[HandPress] = []
    for action in actions:
        if not isinstance(action.command, SetButtons):
            continue
        pressed = action.command.pressed
        for name in [name for name in since if name not in pressed]:
            presses.append(HandPress(name, since.pop(name) / hz, action.tick / hz))
        since |= {name: action.tick for name in pressed if name in names and name not in since}
    return (*presses, *(HandPress(name, tick / hz, ticks / hz) for name, tick in since.items()))


def find_hits(presses: Iterable[HandPress], names: Sequence[str]) -> list[HandPress]:
    """Return the presses of certain buttons or touch sensors; a press of all touch sensors together is always included.

    Args:
        presses: The presses.
        names: The names of the buttons and sensors; if this is empty, all presses are returned.
    """
    return [press for press in presses if not names or press.name in (*names, TOUCH)]
