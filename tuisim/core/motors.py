"""Wheel motors: what they were told, how their speed ramps, when a move is over.

A motor is changed in place, tick by tick: this is the hottest data of the simulation.
Angles in degrees of the wheel (one encoder count is one degree), speeds in degrees per
second.
"""

from __future__ import annotations

import math
from bisect import bisect_left
from dataclasses import dataclass
from itertools import accumulate, repeat
from operator import neg

from tuisim.core.profile import ProfileSpec

STOPPED, FOREVER, TIMED, POSITION = range(4)
"""What a motor is doing."""

ENDLESS = 1 << 60
"""More ticks than any run has."""


MEDIUM_MAX_SPEED_DPS = 1560.0
"""Medium motor, no load (EV3 motor driver table)."""

STANDS_STILL_DEG = 1e-3
"""A wheel that turns less in a tick stands still."""


def top_speed_dps(kind: str, profile: ProfileSpec) -> float:
    """Return how fast a motor of a kind turns without a load."""
    return MEDIUM_MAX_SPEED_DPS if kind == "medium" else profile.max_speed_dps


@dataclass(frozen=True, slots=True)
class MotorState:
    """A motor before a tick."""

    mode: int
    sign: float
    target_dps: float
    position_deg: float


def ramped(speed: float, target: float, step: float, whole: bool) -> float:
    """Return the speed one tick later.

    Args:
        speed: Speed now.
        target: Speed asked for.
        step: Change allowed in a tick; 0 for a motor without inertia.
        whole: Round a speed of 0 or more to whole degrees per second.
    """
    if step == 0.0:
        speed = target
    elif speed < target:
        speed += step
        if speed > target:
            speed = target
    elif speed > target:
        speed -= step
        if speed < target:
            speed = target
    return float(int(speed + 0.5)) if whole and speed >= 0 else speed


class Motor:
    """One motor with its encoder.

    Args:
        max_dps: Noise makes it no faster than this.
    """

    __slots__ = (
        "approach_dps2", "blocked_ticks", "counts_on_dps", "end_tick", "goal_deg", "max_dps", "mode", "position_deg",
        "sign", "slowest_ramp_dps2", "speed_dps", "target_dps",
    )  # fmt: skip

    def __init__(self, max_dps: float) -> None:
        self.max_dps = max_dps
        self.mode = STOPPED
        self.position_deg = 0.0
        self.speed_dps = 0.0
        """Speed the motor has reached; with `keep_speed_when_stopped` also remembered when it stands."""
        self.target_dps = 0.0
        self.sign = 1.0
        """-1 while a move goes backwards at a speed given without sign."""
        self.goal_deg = 0.0
        self.end_tick = 0
        self.slowest_ramp_dps2 = 0.0
        """Change of speed a second that the program asked for; 0 leaves it to the motor's weight."""
        self.approach_dps2 = 0.0
        """How it slows down before a goal or the end of its time; 0: it stops at once when it is there."""
        self.blocked_ticks = 0
        """For how many ticks something solid has kept the wheel from turning."""
        self.counts_on_dps = 0.0
        """How fast the encoder goes on counting though the wheel stands (halved position moves)."""

    def run(self, speed_dps: float) -> None:
        """Run until told otherwise."""
        if self.mode == FOREVER and not (self.slowest_ramp_dps2 or self.blocked_ticks):
            # A control loop steers like this a hundred times a second: only the speed is new.
            self.target_dps = speed_dps
        else:
            self._begin(FOREVER, speed_dps, 1.0)

    def run_until(self, speed_dps: float, end_tick: int) -> None:
        """Run until a tick is over."""
        self._begin(TIMED, speed_dps, 1.0)
        self.end_tick = end_tick

    def run_to(self, goal_deg: float, speed_dps: float, backwards: bool) -> None:
        """Run to an encoder position at a speed given without sign."""
        self._begin(POSITION, abs(speed_dps), -1.0 if backwards else 1.0)
        self.goal_deg = goal_deg

    def _begin(self, mode: int, speed_dps: float, sign: float) -> None:
        if sign != self.sign:
            # The wheel keeps turning the way it turns: only the way it is written down changes.
            self.speed_dps = -self.speed_dps
        self.mode, self.target_dps, self.sign = mode, speed_dps, sign
        self.slowest_ramp_dps2 = self.approach_dps2 = 0.0
        self.counts_on_dps = 0.0
        self.blocked_ticks = 0

    def stop(self, profile: ProfileSpec) -> None:
        """Stand still now."""
        self.mode = STOPPED
        self.target_dps = 0.0
        self.counts_on_dps = 0.0
        self.blocked_ticks = 0
        if not profile.keep_speed_when_stopped:
            self.speed_dps = 0.0
            self.sign = 1.0

    def state(self) -> MotorState:
        """Return what `hold_back` needs to undo a tick."""
        return MotorState(self.mode, self.sign, self.target_dps, self.position_deg)

    def hold_back(self, before: MotorState, turned_deg: float, part: float) -> None:
        """Undo the rest of a tick in which something solid stopped the wheel.

        Args:
            before: The state before the tick.
            turned_deg: What the tick turned the wheel.
            part: The part of it that was possible, below 1.
        """
        if before.mode == STOPPED or turned_deg == 0.0:
            return
        if before.mode == POSITION and self.mode == STOPPED:
            # It did not get to its goal after all.
            self.mode, self.sign, self.target_dps = before.mode, before.sign, before.target_dps
        self.position_deg = before.position_deg + (self.position_deg - before.position_deg) * part
        self.speed_dps *= part
        self.blocked_ticks = self.blocked_ticks + 1 if abs(turned_deg * part) < STANDS_STILL_DEG else 0

    @property
    def moving_dps(self) -> float:
        """The speed at which the wheel turns, with its sign."""
        return 0.0 if self.mode == STOPPED else self.speed_dps * self.sign

    def ramp_step(self, weight_step: float, tick_s: float) -> float:
        """Return by how much the speed can change in a tick; 0 is at once.

        Args:
            weight_step: What the motor's weight allows, 0 for a weightless one.
            tick_s: Length of a tick in seconds.
        """
        if not self.slowest_ramp_dps2:
            return weight_step
        asked = self.slowest_ramp_dps2 * tick_s
        return min(weight_step, asked) if weight_step else asked

    def ramp_ahead(self, ticks: int, step: float, whole: bool) -> list[float]:
        """Change the speed as so many ticks do, and return it for each of them."""
        speed, target = self.speed_dps, self.target_dps
        if whole:
            speeds = []
            for _ in range(ticks):
                if speed != target:
                    speed = ramped(speed, target, step, whole)
                speeds.append(speed)
        elif speed == target or step == 0.0:
            speeds = [target] * ticks
        else:
            # The sums of `ramped`, without a call for each; those beyond the target become it.
            change = step if speed < target else -step
            speeds = list(accumulate(repeat(change, ticks - 1), initial=speed + change))
            short = bisect_left(speeds, target) if change > 0 else bisect_left(speeds, -target, key=neg)
            speeds[short:] = repeat(target, ticks - short)
        self.speed_dps = speeds[-1]
        return speeds

    def quiet_ticks(self, tick: int, tick_s: float, halved: bool) -> int:
        """Return for how many ticks nothing but the ramp can change this motor.

        Args:
            tick: Ticks done.
            tick_s: Length of a tick in seconds.
            halved: Whether the encoder counts twice in a move to a position.
        """
        if self.approach_dps2:
            return 0
        if self.mode == TIMED:
            return max(0, self.end_tick - tick - 1)
        if self.mode == POSITION:
            fastest = max(abs(self.speed_dps), abs(self.target_dps)) * tick_s
            if fastest == 0.0:
                return ENDLESS
            left = (self.goal_deg - self.position_deg) * self.sign
            return max(0, int(left / (2 * fastest if halved else fastest)) - 1)
        return ENDLESS

    def step(self, tick: int, profile: ProfileSpec, ramp_step: float, tick_s: float, noise_dps: float) -> float:
        """Do one tick, whatever it brings.

        Args:
            tick: The tick that is being done.
            profile: The rules.
            ramp_step: Change of speed in a tick that the weight allows.
            tick_s: Length of a tick in seconds.
            noise_dps: Added to the speed; 0 for none.

        Returns:
            Degrees by which the wheel turned.
        """
        if self.mode == STOPPED:
            self.position_deg += self.counts_on_dps * tick_s
            return 0.0
        if self.mode == TIMED and (tick > self.end_tick or (tick == self.end_tick and profile.timed_stop_skips_tick)):
            self.stop(profile)
            return 0.0
        step = self.ramp_step(ramp_step, tick_s)
        self.speed_dps = ramped(self.speed_dps, self.target_dps, step, profile.round_forward_speeds)
        if self.approach_dps2:
            self._slow_down(tick, ramp_step, tick_s)
        speed = self._disturbed(profile, noise_dps) if noise_dps else self.speed_dps
        turned = speed * self.sign * tick_s
        if self.mode == POSITION:
            return self._step_to_goal(turned, profile)
        self.position_deg += turned
        if self.mode == TIMED and tick == self.end_tick:
            self.stop(profile)
        return turned

    def _slow_down(self, tick: int, weight_step: float, tick_s: float) -> None:
        """Keep the speed so low that the motor can stand at its goal, or at the end of its time."""
        change = self.ramp_down_step(weight_step, tick_s)
        if self.mode == TIMED:
            limit = change * max(0, self.end_tick - tick)
        else:
            left = max(0.0, (self.goal_deg - self.position_deg) * self.sign)
            half = change / 2
            limit = math.sqrt(half * half + 2 * change * left / tick_s) - half
        if abs(self.speed_dps) > limit:
            self.speed_dps = math.copysign(limit, self.speed_dps)

    def ramp_down_step(self, weight_step: float, tick_s: float) -> float:
        """Return by how much the speed falls in a tick while the motor slows down by itself."""
        asked = self.approach_dps2 * tick_s
        return min(weight_step, asked) if weight_step else asked

    def _step_to_goal(self, turned: float, profile: ProfileSpec) -> float:
        left = (self.goal_deg - self.position_deg) * self.sign
        if profile.halve_position_moves:
            if turned * self.sign > left:
                # The encoder counts this step, the wheel does not make it, and the count goes on.
                self.position_deg += turned
                counts_on = self.target_dps * self.sign
                self.stop(profile)
                self.counts_on_dps = counts_on
                return 0.0
            self.position_deg += 2 * turned
            return turned
        if turned * self.sign >= left:
            turned = self.goal_deg - self.position_deg
            self.position_deg = self.goal_deg
            self.stop(profile)
            return turned
        self.position_deg += turned
        return turned

    def _disturbed(self, profile: ProfileSpec, noise_dps: float) -> float:
        limit = self.max_dps
        if profile.forward_noise_only:
            if self.speed_dps >= 0:
                self.speed_dps = min(limit, float(round(self.speed_dps + noise_dps)))
            return self.speed_dps
        if self.speed_dps == 0.0:
            return 0.0
        return max(-limit, min(limit, float(round(self.speed_dps + noise_dps))))
