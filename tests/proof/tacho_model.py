"""A model of a tacho motor, from the documented rules of the kernel's driver: attributes and state words, no motion."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

RANGES: Mapping[str, tuple[int, int]] = {
    "duty_cycle_sp": (-100, 100),
    "time_sp": (0, 2**31 - 1),
    "ramp_up_sp": (0, 60_000),
    "ramp_down_sp": (0, 60_000),
    "speed_p": (0, 2**31 - 1),
    "speed_i": (0, 2**31 - 1),
    "speed_d": (0, 2**31 - 1),
    "position_p": (0, 2**31 - 1),
    "position_i": (0, 2**31 - 1),
    "position_d": (0, 2**31 - 1),
    "position_sp": (-(2**31), 2**31 - 1),
}
"""The smallest and the largest value that the driver takes; for speed_sp it depends on the motor."""
WORDS: Mapping[str, tuple[str, ...]] = {
    "stop_action": ("coast", "brake", "hold"),
    "polarity": ("normal", "inversed"),
}
FLAGS = ("running", "ramping", "holding", "overloaded", "stalled")
NEAR = 40
"""Counts that a motor may roll on where the driver does not hold it."""


@dataclass(frozen=True, slots=True)
class About:
    """A number that motion has a part in."""

    value: float
    by: float

    def __eq__(self, other: object) -> bool:
        return isinstance(other, int | float) and abs(other - self.value) <= self.by

    __hash__ = None  # type: ignore[assignment]


@dataclass(frozen=True, slots=True)
class Flags:
    """State words that must be there, and those that must not; the others depend on motion."""

    there: tuple[str, ...]
    gone: tuple[str, ...]

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, list) or other != [flag for flag in FLAGS if flag in other]:
            return False
        return set(self.there) <= set(other) and not set(self.gone) & set(other)

    __hash__ = None  # type: ignore[assignment]


def _defaults(hold_p: int) -> dict[str, Any]:
    zeros = dict.fromkeys(
        ("position_sp", "speed_sp", "duty_cycle_sp", "time_sp", "ramp_up_sp", "ramp_down_sp"), 0
    )
    regulation = {
        "speed_p": 1000,
        "speed_i": 60,
        "speed_d": 0,
        "position_p": hold_p,
        "position_i": 0,
        "position_d": 0,
    }
    return {**zeros, **regulation, "stop_action": "coast", "polarity": "normal"}


@dataclass
class TachoMotor:
    """The model."""

    max_speed: int
    hold_p: int
    settings: dict[str, Any] = field(default_factory=dict)
    """Without those whose value the rules leave open."""
    position: float = 0.0
    near: float = 0.0
    """How far the position may be from that."""
    relative_to: tuple[float, float] | None = None
    """The target of the last command, if that was run-to-rel-pos, and how far from that it may be."""
    state: Flags = field(default_factory=lambda: Flags((), FLAGS))
    rising: int = 0
    """The direction in which a motor runs without an end: 1, -1, or 0."""
    latched: tuple[str, float] | None = None
    """Stop action of the move that goes on, and its target; a target of NaN is open."""
    duty_cycle: int | None = None
    speed: About | None = None

    def __post_init__(self) -> None:
        self.settings = _defaults(self.hold_p)

    @property
    def is_running(self) -> bool:
        """Whether a command goes on."""
        return "running" in self.state.there

    def expected(self) -> dict[str, Any]:
        """Return the attributes that the rules fix now, with their values."""
        found: dict[str, Any] = {**self.settings, "state": self.state}
        if not self.is_running:
            found["position"] = About(self.position, self.near)
        elif self.duty_cycle is not None:
            found["duty_cycle"] = self.duty_cycle
        elif self.speed is not None:
            found["speed"] = self.speed
        return found

    def is_taken(self, name: str, value: Any) -> bool:
        """Whether the driver takes a value of a setting."""
        if name in WORDS:
            return value in WORDS[name]
        low, high = RANGES.get(name, (-self.max_speed, self.max_speed))
        return low <= int(value) <= high

    def set(self, name: str, value: Any) -> str:
        """Write a setting; return the error, if there is one."""
        if not self.is_taken(name, value):
            return "ValueError"
        if name == "polarity":
            if value != self.settings["polarity"]:
                self.position = -self.position
                for one in ("position_sp", "speed_sp", "duty_cycle_sp"):
                    self.settings.pop(one, None)
            self.settings[name] = value
            return ""
        self.settings[name] = value if name in WORDS else int(value)
        if name == "duty_cycle_sp" and self.duty_cycle is not None:
            self.duty_cycle = int(value)
            self.rising = _sign(self.duty_cycle)
        return ""

    def write_position(self, value: int) -> None:
        """Set the position of a motor that stands."""
        self.position, self.near, self.relative_to = value, 0.0, None

    def reset(self) -> None:
        """Do the command of that name."""
        near = NEAR if self.is_running else 0.0
        self._command()
        self.settings = _defaults(self.hold_p)
        self.position, self.near, self.state = 0.0, near, Flags((), FLAGS)

    def stop(self) -> None:
        """Do the command of that name."""
        was_running = self.is_running
        self._command()
        self._stand(self.settings["stop_action"])
        self.near = float("inf") if was_running else max(self.near, 2.0)

    def run_direct(self) -> None:
        """Do the command of that name."""
        self._command()
        # No ramp limits it.
        self.state = Flags(("running",), ("ramping", "holding"))
        self.duty_cycle = self.settings["duty_cycle_sp"]
        self.rising = _sign(self.duty_cycle)

    def run_forever(self) -> None:
        """Do the command of that name."""
        self._command()
        self._run()
        speed = self.settings["speed_sp"]
        self.rising = _sign(speed)
        self.speed = About(speed, abs(speed) * 0.2 + 10)

    def run_timed(self) -> None:
        """Do the command of that name."""
        self._command()
        self._run()
        self.latched = self.settings["stop_action"], float("nan")

    def run_to(self, relative: bool) -> None:
        """Do run-to-rel-pos or run-to-abs-pos."""
        base, near = self.relative_to or (
            self.position,
            float("inf") if self.is_running else self.near,
        )
        target = float(self.settings["position_sp"])
        if relative and not target:
            self.stop()
            return
        self._command()
        if relative:
            target += base
            # What cannot be known of the position cannot be known of the target.
            self.relative_to, self.near = (target, near), near
        else:
            self.near = 0.0
        self._run()
        self.latched = self.settings["stop_action"], target

    def end_of_move(self, position: float) -> None:
        """Let a move end that was given the time for it, at the position that is read if the rules leave it open."""
        assert self.latched is not None
        action, target = self.latched
        base = self.relative_to
        self._command()
        self.relative_to = base
        self._stand(action)
        if target == target:
            self.position = target
            self.near += 1.0 if action == "hold" else NEAR
        else:
            self.position, self.near = position, 0.0

    def _command(self) -> None:
        self.relative_to = self.latched = self.duty_cycle = self.speed = None
        self.rising = 0

    def _run(self) -> None:
        self.state = Flags(("running",), ("holding",))

    def _stand(self, action: str) -> None:
        there = ("holding",) if action == "hold" else ()
        self.state = Flags(there, ("running", "ramping", "stalled", *({"holding"} - set(there))))


def _sign(number: float) -> int:
    return (number > 0) - (number < 0)
