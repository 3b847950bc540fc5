"""Motors of the browser simulator nbev3devsim, reproduced to the last bit.

A motor has a speed register that follows its set point in every tick, even while the motor is stopped, and a command
that decides how the register is used. In a move to a position the encoder counts each step twice, so the wheel covers
half the distance, and it continues to count after the end. A set point that a program writes takes effect immediately.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import accumulate, islice, repeat

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


class BrowserMotor:
    """One motor of the browser simulator with its encoder.

    Args:
        tick_hz: Ticks per second.
        ramp_step: Largest change of speed, in degrees per second, that the robot's weight allows in one tick; 0 for no
            limit.
        limit_dps: Highest forward speed.
    """

    __slots__ = (
        "_command",
        "_limit_dps",
        "_ramp_step",
        "_tick_s",
        "backwards",
        "blocked_ticks",
        "end_tick",
        "goal_deg",
        "mode",
        "position_deg",
        "roll_sign",
        "speed_dps",
        "speed_sp",
    )

    def __init__(self, tick_hz: int, ramp_step: float, limit_dps: float) -> None:
        self._tick_s = 1.0 / tick_hz
        self._limit_dps = limit_dps
        self._ramp_step = ramp_step or math.inf
        self._command = STOPPED
        self.mode = STOPPED
        """What the motor does, while it reports `running`."""
        self.position_deg = 0.0
        self.speed_dps = 0.0
        """The speed register: a magnitude in moves to a position, otherwise a signed speed."""
        self.speed_sp = 0.0
        """The speed that the register follows, in every state."""
        self.backwards = False
        """Whether a move to a position turns backwards; this may change during the move and afterwards."""
        self.goal_deg = 0.0
        self.end_tick = 0.0
        self.roll_sign = 1.0
        """-1 for a motor of inversed polarity: the wheel rolls the other way, the encoder counts as usual."""
        self.blocked_ticks = 0

    # Commands

    def run(self, speed_dps: float) -> None:
        """Run the motor at a speed until the next command."""
        self._begin(FOREVER, speed_dps)

    def run_until(self, speed_dps: float, end_tick: float) -> None:
        """Run the motor at a speed in all ticks before `end_tick`, which need not be a whole number."""
        self._begin(TIMED, speed_dps)
        self.end_tick = end_tick

    def run_to(self, goal_deg: float, speed_dps: float, backwards: bool) -> None:
        """Run the motor to an encoder position.

        Args:
            goal_deg: The encoder position.
            speed_dps: Its sign is ignored.
            backwards: Whether to turn backwards, wherever the goal is.
        """
        self._begin(POSITION, speed_dps)
        self.goal_deg = goal_deg
        self.backwards = backwards
        if goal_deg == self.position_deg:
            self.mode = STOPPED

    def _begin(self, command: int, speed_dps: float) -> None:
        self._command = self.mode = command
        self.speed_sp = speed_dps
        self.blocked_ticks = 0

    def stop(self) -> None:
        """Stop the motor from the next tick on, and set `blocked_ticks` to 0."""
        self._command = STOPPED
        self.blocked_ticks = 0

    # Ticks

    def step(self, tick: int, noise_dps: float) -> float:
        """Run the tick `tick` with noise added to the motor's speed; return the rotation of the wheel in degrees."""
        speed = self.speed_dps
        if speed != self.speed_sp or noise_dps:
            self.speed_dps = speed = self._step_register(speed, noise_dps)
        turned = speed * self._tick_s
        command = self._command
        if command == FOREVER or (command == TIMED and tick < self.end_tick):
            self.position_deg += turned
            return turned * self.roll_sign + 0.0
        if command != POSITION:
            self.mode = STOPPED
            return 0.0
        if self.backwards:
            turned = -turned
        self.position_deg += turned
        if self._is_beyond_goal():
            self.mode = STOPPED
            return 0.0
        self.position_deg += turned
        return turned * self.roll_sign + 0.0

    def _step_register(self, speed: float, noise_dps: float = 0.0) -> float:
        """Return the value of the motor's speed register one tick after the value `speed`, in degrees per second.

        The value comes closer to the speed that the program has set, and has the noise `noise_dps` added.
        """
        target = self.speed_sp
        step = self._ramp_step
        if speed < target:
            speed += step
            if speed > target:
                speed = target
        elif speed > target:
            speed -= step
            if speed < target:
                speed = target
        # A speed that is negative even with the noise is left unchanged.
        noisy = speed + noise_dps
        if noisy < 0.0:
            return speed
        noisy = float(math.floor(noisy + 0.5))
        return noisy if noisy <= self._limit_dps else self._limit_dps

    def _is_beyond_goal(self) -> bool:
        return (
            self.position_deg < self.goal_deg
            if self.backwards
            else self.position_deg > self.goal_deg
        )

    @property
    def _aim(self) -> float:
        """The speed in degrees per second that the motor's speed register approaches."""
        return min(self.speed_sp, self._limit_dps)

    @property
    def _ended(self) -> bool:
        """Whether the last move to a position is over. The wheel then stands still; the encoder goes on counting."""
        return self._command == POSITION and self.mode == STOPPED

    # Ticks ahead

    @property
    def ramping_ticks(self) -> int:
        """Approximate number of ticks until the speed register is steady; 0 only if it is steady."""
        if self.speed_dps == self.speed_sp <= self._limit_dps:
            return 0
        way = abs(self._aim - self.speed_dps)
        return math.ceil(way / self._ramp_step) or int(way > 0)

    def count_quiet_ticks(self, tick: int) -> int:
        """Return the number of ticks after `tick` in which only the speed register changes.

        See `Motor.count_quiet_ticks`.
        """
        if self._command == FOREVER or (self.mode == STOPPED and self._command != POSITION):
            return ENDLESS
        if self._command == POSITION:
            return self._count_ticks_before_goal()
        # After a stop command the state changes in the next tick, so there is no quiet tick.
        return max(0, math.ceil(self.end_tick) - 1 - tick) if self._command == TIMED else 0

    def _count_ticks_before_goal(self) -> int:
        if self._ended and self.speed_dps == self.speed_sp == 0.0:
            return ENDLESS
        if self._ended:
            # The move stays over only while the motor is beyond its goal, and does not turn back.
            return (
                ENDLESS
                if self._is_beyond_goal() and self.speed_dps >= 0 and self.speed_sp >= 0
                else 0
            )
        # Rounding can add up to half a degree per second to the speed.
        fastest = (max(abs(self.speed_dps), abs(self.speed_sp)) + 0.5) * self._tick_s
        left = abs(self.goal_deg - self.position_deg)
        return 0 if self._is_beyond_goal() else max(0, int(left / (2 * fastest)) - 1)

    def glide_evenly(self, ticks: int) -> EvenGlide:
        """Return the motor's motion over several ticks at constant speed.

        `position_deg` is not changed: the caller sets it after that.
        """
        turned = self.speed_dps * (
            -self._tick_s if self._command == POSITION and self.backwards else self._tick_s
        )
        start = self.position_deg
        counts: Iterator[float]
        if self.mode == STOPPED and not self._ended:
            return EvenGlide(0.0, repeat(start, ticks))
        if self.mode == STOPPED or self._command != POSITION:
            counts = accumulate(repeat(turned, ticks - 1), initial=start + turned)
        else:
            counts = islice(accumulate(repeat(turned, 2 * ticks), initial=start), 2, None, 2)
        return EvenGlide(0.0 if self.mode == STOPPED else turned * self.roll_sign + 0.0, counts)

    def glide(self, ticks: int) -> Glide:
        """Advance the motor by several ticks in which only its speed register changes; return how it moves."""
        speeds = self._advance_registers(ticks)
        tick_s = -self._tick_s if self._command == POSITION and self.backwards else self._tick_s
        turns = [speed * tick_s for speed in speeds]
        counts = self._count_positions(turns)
        self.position_deg = counts[-1]
        if self.mode == STOPPED:
            return Glide([0.0] * ticks, counts)
        sign = self.roll_sign
        return Glide([turned * sign + 0.0 for turned in turns], counts)

    def _advance_registers(self, ticks: int) -> list[float]:
        """Advance the speed register by `ticks` ticks; return its value after each tick, in degrees per second."""
        speed = self.speed_dps
        aim = self._aim
        speeds: list[float] = []
        while speed != aim and len(speeds) < ticks:
            speed = self._step_register(speed)
            speeds.append(speed)
        self.speed_dps = speed
        speeds += [speed] * (ticks - len(speeds))
        return speeds

    def _count_positions(self, turns: list[float]) -> list[float]:
        start = self.position_deg
        if self._command == POSITION and self.mode != STOPPED:
            twice = (turned for pair in zip(turns, turns, strict=True) for turned in pair)
            return list(accumulate(twice, initial=start))[2::2]
        if self.mode == STOPPED and not self._ended:
            return [start] * len(turns)
        return list(accumulate(turns, initial=start))[1:]

    # The motor's state, for other modules

    @property
    def _direction(self) -> float:
        return (
            self.roll_sign if self._command != POSITION or not self.backwards else -self.roll_sign
        )

    @property
    def moving_dps(self) -> float:
        """Current speed of the wheel in degrees per second, negative if it turns backwards."""
        return 0.0 if self.mode == STOPPED else self.speed_dps * self._direction

    @property
    def counting_dps(self) -> float:
        """Current speed of the encoder's count in degrees per second: twice the wheel's in a move to a position."""
        if self._command == POSITION:
            return self.speed_dps * ((self.mode != STOPPED) + 1) * (-1.0 if self.backwards else 1.0)
        return 0.0 if self.mode == STOPPED else self.speed_dps

    def read_turn(self, now_ns: int) -> tuple[float, float]:
        """Return the encoder's position in degrees and its speed in degrees per second, as of the last tick.

        The speed is 0 while the motor has no command. The values change only with ticks, so `now_ns` makes no
        difference.
        """
        return self.position_deg, self.counting_dps if self._command else 0.0

    @property
    def aim_dps(self) -> float:
        """Target speed of the wheel in degrees per second, negative if it is to turn backwards; 0 while stopped."""
        return 0.0 if self.mode == STOPPED else self._aim * self._direction

    @property
    def resting(self) -> bool:
        """Whether the motor stays unchanged until its next command."""
        return (
            self.mode == STOPPED
            and self.speed_dps == self._aim
            and (self.speed_dps == 0.0 or not self._ended)
        )

    # Collisions

    def state(self) -> MotorState:
        """Return the state of the motor before a tick, from which `hold_back` can undo the tick."""
        return self.mode, self._direction, self._aim, self.position_deg

    def hold_back(self, before: MotorState, turned_deg: float, part: float) -> None:
        """Undo the motion of the last tick beyond the point at which an obstacle stopped the wheel.

        Args:
            before: The motor's `state` before the tick.
            turned_deg: How far the wheel would have turned in the tick without the obstacle.
            part: The fraction of the tick's motion that the obstacle allowed, below 1.
        """
        mode, *_, position_deg = before
        if mode == STOPPED or turned_deg == 0.0:
            return
        self.position_deg = position_deg + (self.position_deg - position_deg) * part
        self.speed_dps *= part
        self.blocked_ticks = (
            self.blocked_ticks + 1 if abs(turned_deg * part) < STANDSTILL_DEG else 0
        )
