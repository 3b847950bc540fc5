"""Wheel motors of a brick: their commands, speed ramps and ends of moves.

Motors are mutable objects that change in every tick: most of a simulation's time is spent in them. Angles are in
degrees of the wheel (one encoder count is one degree), speeds in degrees per second.
"""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Sequence
from itertools import accumulate, repeat
from operator import neg

from tuisim.engine.core.drive import EvenGlide, Glide
from tuisim.engine.core.motors import (
    ENDLESS,
    FOREVER,
    POSITION,
    STANDSTILL_DEG,
    STOPPED,
    TIMED,
    MotorState,
)


def ramp_speed(speed: float, target: float, step: float) -> float:
    """Return the speed one tick later: closer to `target` by at most `step`, or equal to it if `step` is 0."""
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
    return speed


class BrickMotor:
    """One motor of a brick with its encoder.

    Args:
        tick_hz: Ticks per second.
        weight_step: Largest change of speed, in degrees per second, that the robot's weight allows in one tick; 0 for
            no limit.
        limit_dps: Highest speed that noise can cause.
    """

    __slots__ = (
        "_limit_dps",
        "_tick_s",
        "_weight_step",
        "approach_dps2",
        "blocked_ticks",
        "end_tick",
        "goal_deg",
        "mode",
        "position_deg",
        "sign",
        "slowest_ramp_dps2",
        "speed_dps",
        "target_dps",
    )

    def __init__(self, tick_hz: int, weight_step: float, limit_dps: float) -> None:
        self._tick_s = 1.0 / tick_hz
        self._weight_step = weight_step
        self._limit_dps = limit_dps
        self.mode = STOPPED
        self.position_deg = 0.0
        self.speed_dps = 0.0
        self.target_dps = 0.0
        self.sign = 1.0
        """-1 while a move whose speed is given without a sign runs backwards, else 1."""
        self.goal_deg = 0.0
        self.end_tick: float = 0
        self.slowest_ramp_dps2 = 0.0
        """Acceleration that the program set; 0 if only the motor's weight limits it."""
        self.approach_dps2 = 0.0
        """Deceleration before the goal or the end time; 0 stops abruptly."""
        self.blocked_ticks = 0
        """Number of consecutive ticks in which an obstacle or wall has blocked the wheel."""

    def run(self, speed_dps: float) -> None:
        """Run the motor at a speed until the next command."""
        if self.mode == FOREVER and not (self.slowest_ramp_dps2 or self.blocked_ticks):
            # A control loop calls this a hundred times a second, and only the speed changes: `_begin` is not needed.
            self.target_dps = speed_dps
        else:
            self._begin(FOREVER, speed_dps, 1.0)

    def run_until(self, speed_dps: float, end_tick: float) -> None:
        """Run the motor at a speed until the end of the tick `end_tick`, and stop it there."""
        self._begin(TIMED, speed_dps, 1.0)
        self.end_tick = end_tick

    def run_to(self, goal_deg: float, speed_dps: float, backwards: bool) -> None:
        """Run the motor to an encoder position, and stop it there.

        Args:
            goal_deg: The encoder position.
            speed_dps: Its sign is ignored.
            backwards: Whether to turn backwards, wherever the goal is.
        """
        self._begin(POSITION, abs(speed_dps), -1.0 if backwards else 1.0)
        self.goal_deg = goal_deg

    def _begin(self, mode: int, speed_dps: float, sign: float) -> None:
        if sign != self.sign:
            # The wheel keeps its direction: only the meaning of the sign changes.
            self.speed_dps = -self.speed_dps
        self.mode = mode
        self.target_dps = speed_dps
        self.sign = sign
        self.slowest_ramp_dps2 = self.approach_dps2 = 0.0
        self.blocked_ticks = 0

    def stop(self) -> None:
        """Stop the motor immediately, without a ramp."""
        self.mode = STOPPED
        self.target_dps = 0.0
        self.blocked_ticks = 0
        self.speed_dps = 0.0
        self.sign = 1.0

    def state(self) -> MotorState:
        """Return the state of the motor before a tick, from which `hold_back` can undo the tick."""
        return self.mode, self.sign, self.target_dps, self.position_deg

    def hold_back(self, before: MotorState, turned_deg: float, part: float) -> None:
        """Undo the motion of the last tick beyond the point at which an obstacle stopped the wheel.

        Args:
            before: The motor's `state` before the tick.
            turned_deg: How far the wheel would have turned in the tick without the obstacle.
            part: The fraction of the tick's motion that the obstacle allowed, below 1.
        """
        mode, sign, target_dps, position_deg = before
        if mode == STOPPED or turned_deg == 0.0:
            return
        if mode == POSITION and self.mode == STOPPED:
            # An obstacle has undone the arrival at the goal: the move goes on.
            self.mode = mode
            self.sign = sign
            self.target_dps = target_dps
        self.position_deg = position_deg + (self.position_deg - position_deg) * part
        self.speed_dps *= part
        self.blocked_ticks = (
            self.blocked_ticks + 1 if abs(turned_deg * part) < STANDSTILL_DEG else 0
        )

    @property
    def moving_dps(self) -> float:
        """Current speed of the wheel in degrees per second, negative if it turns backwards."""
        return 0.0 if self.mode == STOPPED else self.speed_dps * self.sign

    @property
    def counting_dps(self) -> float:
        """Current speed of the encoder's count in degrees per second."""
        return self.moving_dps

    def read_turn(self, now_ns: int) -> tuple[float, float]:
        """Return the encoder's position in degrees and its speed in degrees per second, as of the last tick.

        The values change only with ticks, so `now_ns` makes no difference.
        """
        return self.position_deg, self.counting_dps

    @property
    def aim_dps(self) -> float:
        """Target speed of the wheel in degrees per second, negative if it is to turn backwards; 0 while stopped."""
        return self.target_dps * self.sign if self.mode else 0.0

    @property
    def resting(self) -> bool:
        """Whether the motor stays unchanged until its next command."""
        return self.mode == STOPPED

    @property
    def ramp_step(self) -> float:
        """Largest change of the motor's speed in one tick, in degrees per second; 0 is unlimited."""
        slowest_dps2 = self.slowest_ramp_dps2
        return self._limit_step(slowest_dps2) if slowest_dps2 else self._weight_step

    def _limit_step(self, most_dps2: float) -> float:
        """Return the largest change of speed in one tick that an acceleration and the robot's weight allow."""
        limit_dps = most_dps2 * self._tick_s
        return min(self._weight_step, limit_dps) if self._weight_step else limit_dps

    @property
    def ramping_ticks(self) -> int:
        """Number of ticks until the motor has its target speed."""
        if self.mode == STOPPED or self.speed_dps == self.target_dps:
            return 0
        step = self.ramp_step
        return math.ceil(abs(self.target_dps - self.speed_dps) / step) if step else 1

    def glide_evenly(self, ticks: int) -> EvenGlide:
        """Return the motor's motion over several ticks at constant speed.

        `position_deg` is not changed: the caller sets it after that.
        """
        if self.mode == STOPPED:
            return EvenGlide(0.0, repeat(self.position_deg, ticks))
        turned = self.speed_dps * self.sign * self._tick_s
        return EvenGlide(
            turned, accumulate(repeat(turned, ticks - 1), initial=self.position_deg + turned)
        )

    def glide(self, ticks: int) -> Glide:
        """Advance the motor by several ticks in which only the speed ramp changes it; return how it moves."""
        if self.mode == STOPPED:
            return Glide([0.0] * ticks, [self.position_deg] * ticks)
        sign = self.sign
        tick_s = self._tick_s
        turns = [speed * sign * tick_s for speed in self._advance_speeds(ticks)]
        return self._roll(turns)

    def glide_noisily(self, ticks: int, noise_dps: Sequence[float]) -> Glide:
        """Advance the motor by several ticks as `glide` does, with noise added to its speed; return how it moves.

        Moves to a position cannot be advanced in this way: noise changes the tick in which they end.

        Args:
            ticks: Number of ticks.
            noise_dps: The noise of each tick.
        """
        if self.mode == STOPPED:
            return Glide([0.0] * ticks, [self.position_deg] * ticks)
        sign = self.sign
        tick_s = self._tick_s
        limit = self._limit_dps
        steady = self.speed_dps
        # These are the results of `step` and `_disturb`, computed without a call for each tick.
        if steady == self.target_dps:
            noisy: Sequence[float] = (
                [round(steady + noise) for noise in noise_dps] if steady else [0] * ticks
            )
        else:
            speeds = zip(self._advance_speeds(ticks), noise_dps, strict=True)
            noisy = [round(speed + noise) if speed else 0 for speed, noise in speeds]
        if max(noisy) > limit or min(noisy) < -limit:
            noisy = [max(-limit, min(limit, turn_dps)) for turn_dps in noisy]
        turns = [turn_dps * sign * tick_s for turn_dps in noisy]
        return self._roll(turns)

    def _roll(self, turns: list[float]) -> Glide:
        """Turn the motor by an angle in each of several ticks."""
        counts = list(accumulate(turns, initial=self.position_deg))
        self.position_deg = counts[-1]
        return Glide(turns, counts[1:])

    def _advance_speeds(self, ticks: int) -> list[float]:
        """Advance the speed by `ticks` ticks and return the speed after each tick."""
        speed = self.speed_dps
        target = self.target_dps
        step = self.ramp_step
        if speed == target or step == 0.0:
            speeds = [speed if speed == target else target] * ticks
        else:
            # These are the sums of `ramp_speed`, computed without a call for each tick; the target limits the values.
            change = step if speed < target else -step
            speeds = list(accumulate(repeat(change, ticks - 1), initial=speed + change))
            short = (
                bisect_left(speeds, target) if change > 0 else bisect_left(speeds, -target, key=neg)
            )
            speeds[short:] = repeat(target, ticks - short)
        self.speed_dps = speeds[-1]
        return speeds

    def count_quiet_ticks(self, tick: int) -> int:
        """Return the number of ticks after `tick` in which only the speed ramp changes the motor.

        See `Motor.count_quiet_ticks`.
        """
        if self.approach_dps2:
            return 0
        if self.mode == TIMED:
            return max(0, int(self.end_tick) - tick - 1)
        if self.mode == POSITION:
            fastest = max(abs(self.speed_dps), abs(self.target_dps)) * self._tick_s
            if fastest == 0.0:
                return ENDLESS
            left = (self.goal_deg - self.position_deg) * self.sign
            return max(0, int(left / fastest) - 1)
        return ENDLESS

    def step(self, tick: int, noise_dps: float) -> float:
        """Run the tick `tick` with noise added to the motor's speed; return the rotation of the wheel in degrees."""
        mode = self.mode
        if mode == FOREVER and not noise_dps:
            # The common case: only the ramp matters.
            if self.speed_dps != self.target_dps:
                step = self.ramp_step if self.slowest_ramp_dps2 else self._weight_step
                self.speed_dps = ramp_speed(self.speed_dps, self.target_dps, step)
            turned = self.speed_dps * self.sign * self._tick_s
            self.position_deg += turned
            return turned
        if mode == STOPPED:
            return 0.0
        if mode == TIMED and tick > self.end_tick:
            self.stop()
            return 0.0
        self.speed_dps = ramp_speed(self.speed_dps, self.target_dps, self.ramp_step)
        if self.approach_dps2:
            self._slow_down(tick)
        speed = self._disturb(noise_dps) if noise_dps else self.speed_dps
        turned = speed * self.sign * self._tick_s
        if mode == POSITION:
            return self._step_to_goal(turned)
        self.position_deg += turned
        if mode == TIMED and tick == self.end_tick:
            self.stop()
        return turned

    def _slow_down(self, tick: int) -> None:
        """Limit the speed so that the motor can stop at its goal or at its end time."""
        change = self._limit_step(self.approach_dps2)
        if self.mode == TIMED:
            limit = change * max(0, self.end_tick - tick)
        else:
            left = max(0.0, (self.goal_deg - self.position_deg) * self.sign)
            half = change / 2
            limit = math.sqrt(half * half + 2 * change * left / self._tick_s) - half
        if abs(self.speed_dps) > limit:
            self.speed_dps = math.copysign(limit, self.speed_dps)

    def _step_to_goal(self, turned: float) -> float:
        left = (self.goal_deg - self.position_deg) * self.sign
        if left < 0.0:
            # The program has set the count beyond the goal: stop here, without a jump back to the goal.
            self.stop()
            return 0.0
        if turned * self.sign >= left:
            turned = self.goal_deg - self.position_deg
            self.position_deg = self.goal_deg
            self.stop()
            return turned
        self.position_deg += turned
        return turned

    def _disturb(self, noise_dps: float) -> float:
        if self.speed_dps == 0.0:
            return 0.0
        limit = self._limit_dps
        return max(-limit, min(limit, float(round(self.speed_dps + noise_dps))))
