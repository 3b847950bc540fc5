"""A model of a tacho motor, by the rules of the kernel's driver: attributes, state words, and bounds of motion."""

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
"""Counts that a motor at rest may be turned by a command that is not meant to move it."""
HELD = 1
"""Counts that a motor may be off where it holds: the duty for one of them does not start it."""
MAX_OVERSHOOT = 1.25
"""The share of its speed setpoint that a motor reaches at most."""
ENDS_AT_ONCE = 150
"""Counts: a way that may be gone before a program looks."""


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
    is_running: bool = False
    """Whether a command goes on."""
    fastest: float = 0.0
    """No less than its speed since it stood."""
    may_ramp: bool = False
    """Whether a ramp has begun that nothing surely ended: a later command leaves its state word there."""
    relative_to: tuple[float, float] | None = None
    """The target of the last command, if that was run-to-rel-pos, and how far from that it may be."""
    state: Flags = field(default_factory=lambda: Flags((), FLAGS))
    rising: int = 0
    """The direction in which a motor runs without an end: 1, -1, or 0."""
    latched: tuple[str, float, float] | None = None
    """Stop action of the move that goes on, its target, and how far from that it may be; a target of NaN is open."""
    duty_cycle: int | None = None
    speed: About | None = None

    def __post_init__(self) -> None:
        self.settings = _defaults(self.hold_p)

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
        if name.startswith("position_") and name != "position_sp" and not self.is_running:
            self.near = NEAR
        elif name.startswith("speed_") and name != "speed_sp":
            self.speed = None
        if name == "duty_cycle_sp" and self.duty_cycle is not None:
            self.duty_cycle = int(value)
            self.rising = _sign(self.duty_cycle)
        return ""

    def write_position(self, value: int) -> None:
        """Set the position of a motor that stands."""
        self.position = value
        self.near = 0.0
        self.relative_to = None

    def reset(self) -> None:
        """Do the command of that name."""
        near = self._roll("coast") if self.is_running else HELD
        self._command()
        self.settings = _defaults(self.hold_p)
        self._stand("coast")
        self.position = 0.0
        self.near = near

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
        self._run(self.max_speed)
        self.state = Flags(("running",), ("holding", *self._unramped()))
        self.duty_cycle = self.settings["duty_cycle_sp"]
        self.rising = _sign(self.duty_cycle)

    def run_forever(self) -> None:
        """Do the command of that name."""
        self._command()
        speed = self.settings["speed_sp"]
        self._run(speed)
        self.rising = _sign(speed)
        self.speed = About(speed, abs(speed) * 0.2 + 10)

    def run_timed(self) -> None:
        """Do the command of that name."""
        self._command()
        self._run(self.settings["speed_sp"])
        self.latched = self.settings["stop_action"], float("nan"), 0.0

    def run_to(self, relative: bool) -> None:
        """Do run-to-rel-pos or run-to-abs-pos."""
        base, near = self.relative_to or (
            self.position,
            float("inf") if self.is_running else self.near,
        )
        target = float(self.settings["position_sp"])
        if relative and not target:
            self.stop()
            self.relative_to = base, near
            return
        self._command()
        if relative:
            target += base
            # What cannot be known of the position cannot be known of the target.
            self.relative_to = target, near
        else:
            near = 0.0
        self._run(self.settings["speed_sp"])
        if abs(target - self.position) < near + ENDS_AT_ONCE:
            self.state = Flags((), ())
        self.latched = self.settings["stop_action"], target, near

    def end_of_move(self, position: float) -> None:
        """Let a move end that was given the time for it, at the position that is read if the rules leave it open."""
        assert self.latched is not None
        action, target, near = self.latched
        base = self.relative_to
        has_arrived = target == target
        self._command()
        self.relative_to = base
        self.may_ramp = self.may_ramp and not has_arrived
        roll = self._roll(action)
        self._stand(action)
        if has_arrived:
            self.position = target
            self.near = near + roll
        else:
            self.position = position
            self.near = 0.0

    def _roll(self, action: str) -> float:
        """Return how far from where it stops a motor comes to rest at most."""
        if action == "hold":
            return HELD
        # Shorted it has a time constant below 0.1 s; a large motor that coasts loses 450 deg/s in a second.
        return self.fastest * 0.1 + 10 if action == "brake" else self.fastest**2 / 900 + 20

    def _command(self) -> None:
        self.relative_to = self.latched = self.duty_cycle = self.speed = None
        self.rising = 0

    def _run(self, speed: float) -> None:
        self.is_running, self.state = True, Flags(("running",), ("holding",))
        self.fastest = max(self.fastest, abs(speed) * MAX_OVERSHOOT)
        self.may_ramp |= bool(self.settings["ramp_up_sp"] or self.settings["ramp_down_sp"])

    def _stand(self, action: str) -> None:
        there = ("holding",) if action == "hold" else ()
        # Also to stop it takes a ramp.
        self.may_ramp |= bool(self.settings["ramp_up_sp"] or self.settings["ramp_down_sp"])
        gone = ("running", "stalled", *self._unramped(), *({"holding"} - set(there)))
        self.is_running, self.fastest, self.state = False, 0.0, Flags(there, gone)

    def _unramped(self) -> tuple[str, ...]:
        return () if self.may_ramp else ("ramping",)


def _sign(number: float) -> int:
    return (number > 0) - (number < 0)
