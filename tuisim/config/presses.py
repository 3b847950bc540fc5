"""Presses of the brick's buttons, as texts: `enter@1.0-1.5`."""

from __future__ import annotations

from tuisim.config.options import parse
from tuisim.core.spec import BUTTONS
from tuisim.core.values import Number
from tuisim.data_class import dataclass
from tuisim.errors import ConfigError, nearest

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


def parse_press(text: str, key: str = PRESS) -> ButtonPress:
    """Parse a press such as `enter@1.0-1.5` or `enter@1`.

    Raises:
        ConfigError: there is no such button, or the times are wrong.
    """
    name, at, times = text.partition("@")
    if not at:
        raise ConfigError(
            f"must be BUTTON@FROM or BUTTON@FROM-UNTIL, got {text!r}", "such as enter@1.5", key=key
        )
    if name not in BUTTONS:
        raise ConfigError(f"the brick has no button {name!r}", nearest(name, BUTTONS), key=key)
    seconds = Number(0.0, MAX_PRESS_S)
    # A leading minus is a sign: negative times are refused.
    begin, to, end = (times, "", "") if times.startswith("-") else times.partition("-")
    from_s = parse(seconds, begin, key)
    until_s = parse(seconds, end, key) if to else from_s + DEFAULT_PRESS_S
    if until_s <= from_s:
        raise ConfigError(
            f"{text!r} ends before it begins", "BUTTON@FROM-UNTIL, in simulated seconds", key=key
        )
    return ButtonPress(name, from_s, until_s)
