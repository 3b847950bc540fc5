"""Options of the commands that run programs: limits, answers and pressed buttons."""

from __future__ import annotations

from collections.abc import Sequence

from tuisim.config.command_line import GroupedOption, WordType, option
from tuisim.config.options import parse
from tuisim.core.values import Number
from tuisim.data_class import dataclass
from tuisim.errors import ConfigError, nearest
from tuisim.protocol import BUTTONS, SetButtons, UserAction
from tuisim.runs.handle import DEFAULT_TIME_LIMIT_S

MAX_TIME_LIMIT_S = 1e6

_LIMIT = Number(0.001, MAX_TIME_LIMIT_S)


def timeout_option(group: str, default_s: float = DEFAULT_TIME_LIMIT_S) -> GroupedOption:
    """Return `--timeout S`, in simulated seconds."""
    return option(
        "--timeout", default=default_s, metavar="S", group=group,
        type=WordType(lambda text: parse(_LIMIT, text, "--timeout")),
        help=f"Stop a run after this simulated time in seconds ({default_s:g}).",
    )  # fmt: skip


def input_option(group: str) -> GroupedOption:
    """Return `--input TEXT`: the answers of each run, in order."""
    return option(
        "--input", multiple=True, metavar="TEXT", group=group,
        help="Answer an input() of each program; may be repeated.",
    )  # fmt: skip


PRESS = "--press"
DEFAULT_PRESS_S = 0.1
MAX_PRESS_S = 1e6


@dataclass(frozen=True, slots=True)
class ButtonPress:
    """One button, held for a while; times in simulated seconds."""

    button: str
    """One of `BUTTONS`."""
    from_s: float
    until_s: float


def parse_press(text: str) -> ButtonPress:
    """Parse a press such as `enter@1.0-1.5` or `enter@1`.

    Raises:
        ConfigError: there is no such button, or the times are wrong.
    """
    name, at, times = text.partition("@")
    if not at:
        raise ConfigError(f"must be BUTTON@FROM or BUTTON@FROM-UNTIL, got {text!r}", "such as enter@1.5", key=PRESS)
    if name not in BUTTONS:
        raise ConfigError(f"the brick has no button {name!r}", nearest(name, BUTTONS), key=PRESS)
    seconds = Number(0.0, MAX_PRESS_S)
    # A leading minus is a sign: negative times are refused.
    begin, to, end = (times, "", "") if times.startswith("-") else times.partition("-")
    from_s = parse(seconds, begin, PRESS)
    until_s = parse(seconds, end, PRESS) if to else from_s + DEFAULT_PRESS_S
    if until_s <= from_s:
        raise ConfigError(f"{text!r} ends before it begins", "BUTTON@FROM-UNTIL, in simulated seconds", key=PRESS)
    return ButtonPress(name, from_s, until_s)


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
