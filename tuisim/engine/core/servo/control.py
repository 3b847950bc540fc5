"""A controller: it follows one trajectory, of a motor or of the sum or difference of two.

The simulated motor follows its trajectory exactly, as long as no obstacle holds it back. If an obstacle does, and the
motor's power is used up, the trajectory of a move to a position pauses, and a move at a speed gives up the distance
that it cannot catch up.
"""

from __future__ import annotations

from collections.abc import Callable
from enum import IntEnum

from tuisim.engine.core.servo.settings import (
    COUNTS_PER_DEG,
    FULL_ACTUATION,
    PAUSE_MARGIN_MS,
    ControlSettings,
)
from tuisim.engine.core.servo.trajectory import (
    MILLI,
    MS_US,
    Measure,
    Segment,
    Trajectory,
    build_angle_move,
    build_endless_move,
    build_rest,
    build_timed_move,
    divide,
    scale_move,
)


class Ending(IntEnum):
    """What a motor does after a move; the values are those of `pybricks.parameters.Stop`."""

    COAST = 0
    BRAKE = 1
    HOLD = 2
    NONE = 3
    """The motor keeps on running."""
    COAST_SMART = 4
    BRAKE_SMART = 5


def _splice(
    start: Segment, spliced: Segment | None, build: Callable[[Segment], Trajectory]
) -> Trajectory:
    """Return the trajectory of a new motion.

    If the new motion goes on with the same acceleration as the previous one, the trajectory begins where that
    acceleration began.

    Args:
        start: Where, when and how fast the new motion begins.
        spliced: The segment of the previous trajectory that is running at the start; None if there is none.
        build: Takes a start, and returns the trajectory from it.
    """
    trajectory = build(start)
    if spliced is None or trajectory.first.acceleration != start.acceleration:
        return trajectory
    return build(spliced)


BRAKING = Ending.BRAKE, Ending.BRAKE_SMART


class Controller:
    """A controller, which makes a motor or drive base follow a trajectory; without a trajectory it is passive.

    Args:
        settings: The limits, gains and tolerances, in counts.
        slips: Whether the motion after a blocked one begins at the measured position. Otherwise it begins where the
            blocked motion should have been. On a real robot both are equal: while a wall holds the robot back, the
            wheels slide on the floor and turn on, and so do their encoders.
    """

    __slots__ = (
        "_behind_milli",
        "_goal",
        "_paused_us",
        "_slips",
        "_stalled_us",
        "duty_limit",
        "seeks_stall",
        "settings",
        "settles",
        "timed",
        "trajectory",
    )

    def __init__(self, settings: ControlSettings, *, slips: bool = False) -> None:
        self.settings = settings
        self._slips = slips
        self.trajectory: Trajectory | None = None
        """The trajectory to follow; None while the controller is passive."""
        self.timed = False
        """Whether the motion is at a speed, not to a position."""
        self.settles = False
        """Whether a motion for a time is done only when the motor has come to rest."""
        self.duty_limit: int | None = None
        """Highest power of the current move, in hundredths of a percent; None for that of the settings."""
        self.seeks_stall = False
        """Whether the motion goes on until something stops the motor."""
        self._goal: Segment | None = None
        """For a motion that goes on after a move: where the move would have ended, with its rate."""
        self._paused_us = 0
        """For how long, in µs, the trajectory of the present motion has been paused in all."""
        self._behind_milli = 0
        """How far a motion at a speed is behind its trajectory for good, in thousandths of a count."""
        self._stalled_us = 0
        """For how long the motion has hardly moved at full power, in µs."""

    @property
    def actuation(self) -> int:
        """The highest power that the controller may use, in hundredths of a percent."""
        return self.settings.actuation if self.duty_limit is None else self.duty_limit

    # Where the motion should be, and how fast

    def milli(self, now_us: int) -> int:
        """Return the position that the controlled motion should have at a time, in thousandths of a count."""
        assert self.trajectory is not None
        then_us = now_us - self._paused_us
        return self.trajectory.find_segment(then_us).find_milli(then_us) - self._behind_milli

    def find_target(self, now_us: int, _motor: object) -> int:
        """Return the position that the controlled motor should have at a time in µs, in half thousandths of a count."""
        return 2 * self.milli(now_us)

    def rate(self, now_us: int, _motor: object = None) -> int:
        """Return the rate that the motion should have at a time in µs, in counts per second; 0 without a trajectory."""
        if self.trajectory is None:
            return 0
        then_us = now_us - self._paused_us
        return self.trajectory.find_segment(then_us).find_rate(then_us)

    @property
    def end_us(self) -> int | None:
        """Time in µs at which the controller's trajectory ends; None without a trajectory, or if that has no end."""
        if self.trajectory is None or self.trajectory.endless:
            return None
        return self.trajectory.end_us + self._paused_us

    def find_segment_end_us(self, now_us: int) -> int | None:
        """Return the time in µs at which the current segment of the trajectory ends; None if it has no end."""
        if self.trajectory is None:
            return None
        end_us = self.trajectory.find_segment_end_us(now_us - self._paused_us)
        return None if end_us is None else end_us + self._paused_us

    # Commands

    def release(self) -> None:
        """Remove the trajectory, so that the controller is passive."""
        self.trajectory = None
        self.duty_limit = None
        self._stalled_us = 0

    def hold(self, now_us: int, milli: int) -> None:
        """Make the controller hold a position, in thousandths of a count, from a time in µs on."""
        self._begin(build_rest(now_us, milli), timed=False)

    def move_to_position(
        self,
        now_us: int,
        measured: Measure,
        target: int,
        rate: int,
        acceleration: int,
        *,
        relative: bool = False,
        deceleration: int | None = None,
    ) -> None:
        """Begin a move to a position.

        Args:
            now_us: The present time.
            measured: Returns where the motion is; the move begins there if this controller is passive.
            target: Where the move ends, in counts.
            rate: The speed of the move in counts/s; its sign is ignored.
            acceleration: Acceleration at the beginning, in counts/s².
            deceleration: Deceleration at the end, in counts/s²; None for the same as `acceleration`.
            relative: Whether `target` is relative to where the motion begins.

        Raises:
            ValueError: the rate is 0, or the move takes too long.
        """
        settings = self.settings
        rate = min(abs(rate), settings.speed)
        acceleration = self._limit(acceleration)
        start, spliced = self._find_start(now_us, measured)
        if relative:
            target += divide(start.milli, MILLI)
        how = target, rate, acceleration, settings.speed, deceleration
        trajectory = _splice(start, spliced, lambda begin: build_angle_move(begin, *how))
        self._begin(trajectory, timed=False)

    def match_pace(self, other: Controller) -> None:
        """Change this controller's trajectory so that it takes the same time as that of the controller `other`.

        It becomes a copy of the trajectory of `other`, scaled to this controller's own distance. If either controller
        has no trajectory, nothing changes.
        """
        if self.trajectory is not None and other.trajectory is not None:
            ours = self.trajectory
            theirs = other.trajectory
            ways = (move.end.milli - move.first.milli for move in (ours, theirs))
            self.trajectory = scale_move(theirs, ours.first.milli, *ways)

    def run_in_proportion(
        self, now_us: int, measured: Measure, other: Controller, part: int, whole: int
    ) -> None:
        """Begin a motion in step with that of the controller `other`; its distances are `part` / `whole` as long.

        Args:
            now_us: The present time.
            measured: Returns where the motion is, from which it begins if this controller is passive.
            other: The other controller.
            part, whole: The factor for distances.
        """
        assert other.trajectory is not None
        start, _ = self._find_start(now_us, measured)
        passed = other.milli(now_us) - other.trajectory.first.milli
        begin = start.milli - divide(passed * part, whole)
        self._begin(scale_move(other.trajectory, begin, part, whole), timed=True)

    def run(
        self,
        now_us: int,
        measured: Measure,
        rate: int,
        acceleration: int,
        time_us: int | None = None,
    ) -> None:
        """Begin a motion at a speed.

        Args:
            now_us: The present time.
            measured: Returns where the motion is; the new one begins there if this controller is passive.
            rate, acceleration: In counts/s and counts/s².
            time_us: How long the motion takes; None if it does not end.

        Raises:
            ValueError: the time is negative or too long.
        """
        if time_us is None and self._is_running_evenly(now_us, rate):
            return
        how = rate, self._limit(acceleration), self.settings.speed

        def build(begin: Segment) -> Trajectory:
            if time_us is None:
                return build_endless_move(begin, *how)
            return build_timed_move(begin, now_us + time_us - begin.start_us, *how)

        trajectory = _splice(*self._find_start(now_us, measured), build)
        # A distance that a motion at a speed has lost stays lost, also in the motion that follows it.
        behind_milli = (
            self._behind_milli
            if self.timed and self.trajectory is not None and not self._slips
            else 0
        )
        self._begin(trajectory, timed=True)
        self._behind_milli = behind_milli

    def keep_running(self, now_us: int, measured: Measure) -> None:
        """Let the move that has just begun run on at its speed, instead of stopping at its target.

        The move is done when it passes the target.

        Args:
            now_us: The present time.
            measured: Returns where the motion is.
        """
        assert self.trajectory is not None
        first, even, _, end, _ = self.trajectory
        acceleration = abs(first.acceleration) or self.settings.acceleration
        self.run(now_us, measured, even.rate, acceleration)
        self._goal = end._replace(rate=even.rate)

    def _limit(self, acceleration: int) -> int:
        """Return the magnitude of the acceleration with which a motion is planned, in counts per second squared.

        That is the magnitude of `acceleration`. Firmware without a speed window also limits it to the acceleration in
        the settings.
        """
        if self.settings.speed_window_ms:
            return abs(acceleration)
        return min(abs(acceleration), self.settings.acceleration)

    def _is_running_evenly(self, now_us: int, rate: int) -> bool:
        """Return whether the motion already runs at the constant rate `rate`, so that it need not begin again."""
        if (
            not self.timed
            or self.trajectory is None
            or self._paused_us
            or self._behind_milli
            or self._stalled_us
        ):
            return False
        even = self.trajectory.even
        # A new trajectory begins at a rounded position, except after whole milliseconds.
        passed_us = now_us - even.start_us
        return (
            self.trajectory.endless
            and even.rate == rate
            and passed_us >= 0
            and not passed_us % MS_US
        )

    def _find_start(self, now_us: int, measured: Measure) -> tuple[Segment, Segment | None]:
        """Return where a new trajectory begins, and the segment of the present trajectory that is running there.

        The new trajectory begins where the present one has arrived. It begins at the point that `measured` returns if
        there is no trajectory, or if `slips` is set and the motion was blocked.

        Returns:
            The start, and the running segment. The segment is None if there is no trajectory, or if the speed is
                constant.
        """
        if self.trajectory is None or (self._slips and self._behind_milli):
            return measured(now_us), None
        then_us = now_us - self._paused_us
        running = self.trajectory.find_segment(then_us)
        start = Segment(
            now_us, running.find_milli(then_us), running.find_rate(then_us), running.acceleration
        )
        if not running.acceleration:
            return start, None
        return start, running._replace(start_us=running.start_us + self._paused_us)

    def _begin(self, trajectory: Trajectory, *, timed: bool) -> None:
        self.trajectory = trajectory
        self.timed = timed
        self.seeks_stall = False
        self.duty_limit = self._goal = None
        self._paused_us = self._behind_milli = self._stalled_us = 0

    # Following

    def note_lag(self, now_us: int, passed_us: int, milli: int, rate: int) -> None:
        """React to a motion that lags so far behind its trajectory that even full power cannot make it catch up.

        A motion without a target position gives up the missing distance; any other motion pauses its trajectory.

        Args:
            now_us: The present time.
            passed_us: How long the motion has lagged behind, but no longer than since the last call.
            milli, rate: The real position of the motion in thousandths of a count, and its rate in counts per second.
        """
        settings = self.settings
        trajectory = self.trajectory
        assert trajectory is not None
        error = self.milli(now_us) - milli
        full_unm = COUNTS_PER_DEG * settings.torque_unm
        gain = settings.kp * FULL_ACTUATION / full_unm if full_unm else settings.kp
        power = gain * abs(error) // MILLI
        limit = self.actuation - settings.feed_forward + gain * abs(rate) * PAUSE_MARGIN_MS // 1000
        moved = self.milli(now_us) - self.milli(now_us - passed_us)
        # The trajectory goes on if it leads back to where the motor is: a blocked motor is free when it reverses.
        leads_back = (moved if self.timed else trajectory.even.rate) * error < 0
        if power < limit or leads_back:
            self._stalled_us = 0
            return
        if self.timed:
            self._behind_milli += moved
        else:
            self._paused_us += passed_us
        self._stalled_us = self._stalled_us + passed_us if abs(rate) < settings.stall_speed else 0

    @property
    def stalled(self) -> bool:
        """Whether the controlled motion has hardly moved at full power for the stall time of the settings."""
        return (
            self.trajectory is not None and self._stalled_us >= self.settings.stall_time_ms * MS_US
        )

    def has_ended(self, now_us: int) -> bool:
        """Return whether the controller has run a motion for a given time, and this time is over."""
        return self.timed and (end_us := self.end_us) is not None and now_us >= end_us

    def done(self, now_us: int, milli: int, rate: int) -> bool:
        """Return whether no move is under way: none was begun, or the last one is complete.

        Args:
            now_us: The present time.
            milli, rate: The real position of the motion in thousandths of a count, and its rate in counts per second.
        """
        end_us = self.end_us
        is_windowed = self.settings.speed_window_ms > 0
        if end_us is None:
            goal = self._goal
            if goal is None:
                return self.trajectory is None or (is_windowed and not self.seeks_stall)
            return (milli - goal.milli) * goal.rate >= 0
        if now_us < end_us:
            return False
        if self.timed and not (is_windowed and self.settles):
            return True
        near = abs(self.milli(now_us) - milli) <= self.settings.position_tolerance * MILLI
        return near and abs(rate) < self.settings.speed_tolerance

    def lets_go(self, now_us: int, rate: int) -> bool:
        """Return whether a motor whose motion has ended stops following this controller.

        Args:
            now_us: The present time.
            rate: The rate of the motor as the firmware measures it, in counts per second.
        """
        return self.done(now_us, self.milli(now_us), rate if self.settings.speed_window_ms else 0)
