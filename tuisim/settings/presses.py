"""Presses by hand, as texts: `enter@1.0-1.5`, `in1@2`, `remote.left_up@1-3`."""

from __future__ import annotations

from collections.abc import Iterable

from tuisim.base.data_class import dataclass
from tuisim.base.errors import nearest
from tuisim.engine.core.spec import PRESSABLE
from tuisim.engine.core.values import Number, Value, WrongValue
from tuisim.engine.protocol import SetButtons, UserAction

DEFAULT_PRESS_S = 0.1
MAX_PRESS_S = 1e6
MAX_PRESSES = 10_000
_OTHER_NAMES = {"center": "enter", "back": "backspace"}
"""What Pybricks calls buttons of the EV3, and what they are called here."""
_SECONDS = Number(0.0, MAX_PRESS_S)


@dataclass(frozen=True, slots=True)
class Press:
    """A press of one button or touch sensor by hand, from one time to another, in simulated seconds."""

    name: str
    """One of `PRESSABLE`."""
    from_s: float
    until_s: float


def parse_press(text: str) -> Press:
    """Return the press in a text such as `enter@1.0-1.5` or `in1@1`.

    Raises:
        WrongValue: nothing of that name can be pressed, or the times are wrong.
    """
    name, sign, times = text.partition("@")
    if not sign:
        raise WrongValue(f"must be NAME@FROM or NAME@FROM-UNTIL, got {text!r}", "such as enter@1.5")
    name = _OTHER_NAMES.get(name, name)
    if name not in PRESSABLE:
        raise WrongValue(f"{name!r} cannot be pressed", nearest(name, PRESSABLE))
    # A leading minus is a sign, not the dash of a range; negative times are refused below.
    begin, to, end = (times, "", "") if times.startswith("-") else times.partition("-")
    from_s = _SECONDS.parse_text(begin)
    until_s = _SECONDS.parse_text(end) if to else from_s + DEFAULT_PRESS_S
    if until_s <= from_s:
        raise WrongValue(f"{text!r} ends before it begins", "NAME@FROM-UNTIL, in simulated seconds")
    return Press(name, from_s, until_s)


class Presses(Value):
    """The description of an option for presses by hand: its value is a tuple of texts, and each use of it adds one."""

    __slots__ = ()

    @property
    def allowed(self) -> str:
        return "a list of presses such as enter@1.5"

    @property
    def metavar(self) -> str:
        return "NAME@S"

    def parse_data(self, data: object) -> tuple[str, ...]:
        if not isinstance(data, list | tuple):
            raise self.build_error(data)
        if len(data) > MAX_PRESSES:
            raise WrongValue(f"has {len(data)} presses", f"at most {MAX_PRESSES}")
        for number, text in enumerate(data, start=1):
            if not isinstance(text, str):
                raise WrongValue(f"must be text, got {text!r}", part=f"[{number}]")
            try:
                parse_press(text)
            except WrongValue as error:
                raise WrongValue(error.message, error.hint, f"[{number}]") from None
        return tuple(data)

    def parse_text(self, text: str) -> tuple[str, ...]:
        parse_press(text)
        return (text,)


def press_actions(presses: Iterable[str], tick_hz: int) -> tuple[UserAction, ...]:
    """Return the user actions for presses by hand, ordered by tick.

    Args:
        presses: As texts, see `parse_press`; they may overlap, and each lasts at least one tick.
        tick_hz: Ticks per second.
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
