"""Presses by hand, as texts: `enter@1.0-1.5`, `in1@2`, `remote.left_up@1-3`."""

from __future__ import annotations

from tuisim.config.options import parse
from tuisim.core.spec import PRESSABLE
from tuisim.core.values import Number
from tuisim.data_class import dataclass
from tuisim.errors import ConfigError, nearest

PRESS = "--press"
DEFAULT_PRESS_S = 0.1
MAX_PRESS_S = 1e6


@dataclass(frozen=True, slots=True)
class Press:
    """One button or touch sensor, held for a while; times in simulated seconds."""

    name: str
    """One of `PRESSABLE`."""
    from_s: float
    until_s: float


def parse_press(text: str, key: str = PRESS) -> Press:
    """Parse a press such as `enter@1.0-1.5` or `in1@1`.

    Raises:
        ConfigError: nothing of that name can be pressed, or the times are wrong.
    """
    name, at, times = text.partition("@")
    if not at:
        raise ConfigError(
            f"must be NAME@FROM or NAME@FROM-UNTIL, got {text!r}", "such as enter@1.5", key=key
        )
    if name not in PRESSABLE:
        raise ConfigError(f"{name!r} cannot be pressed", nearest(name, PRESSABLE), key=key)
    seconds = Number(0.0, MAX_PRESS_S)
    # A leading minus is a sign: negative times are refused.
    begin, to, end = (times, "", "") if times.startswith("-") else times.partition("-")
    from_s = parse(seconds, begin, key)
    until_s = parse(seconds, end, key) if to else from_s + DEFAULT_PRESS_S
    if until_s <= from_s:
        raise ConfigError(
            f"{text!r} ends before it begins", "NAME@FROM-UNTIL, in simulated seconds", key=key
        )
    return Press(name, from_s, until_s)
