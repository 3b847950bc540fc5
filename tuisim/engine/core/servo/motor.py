"""A servo motor: it follows the trajectory of its own controller or of a drive base, or runs freely.

A motor that follows a trajectory is exactly on it at every time; see `control` for what happens when an obstacle holds
it back. A motor that runs freely is the same electric motor as under other libraries.
"""

from __future__ import annotations

from collections import deque
from itertools import pairwise, repeat
from typing import TYPE_CHECKING, Protocol

from tuisim.engine.core.drive import EvenGlide, Glide
from tuisim.engine.core.driver.plant import Axle
from tuisim.engine.core.motors import (
    ENDLESS,
    FOREVER,
    POSITION,
    STANDSTILL_DEG,
    STOPPED,
    TIMED,
    MotorState,
)
from tuisim.engine.core.servo.control import BRAKING, Controller, Ending
from tuisim.engine.core.servo.settings import (
    COUNTS_PER_DEG,
    compute_motor_settings,
    find_steady_dps,
)
from tuisim.engine.core.servo.trajectory import MILLI, MS_US, Segment

if TYPE_CHECKING:
    from tuisim.engine.core.profile import MotorLaw

PER_PERCENT = 100
MAX_WINDOW_MS = 300
"""The longest time over which the speed of a motor is averaged."""
HALVES_PER_DEG = 2 * MILLI * COUNTS_PER_DEG
"""Positions are kept in half thousandths of a count: a drive base divides a sum of counts by two."""


class Guide(Protocol):
    """The object that a motor follows: a controller or a drive base.

    Times are in µs, positions in half thousandths of a count.
    """

    @property
    def end_us(self) -> int | None:
        """Time in µs at which the motion that the motor follows ends; None if it has no end."""

    def find_target(self, now_us: int, motor: ServoMotor) -> int:
        """Return the position that the motor should have at a time, in half thousandths of a count."""

    def rate(self, now_us: int, motor: ServoMotor) -> float:
        """Return the rate that the motor should have, in counts per second."""

    def find_segment_end_us(self, now_us: int) -> int | None:
        """Return the time in µs at which the current segment of the motion ends; None if it has no end."""

    def note_lag(self, now_us: int, passed_us: int, milli: int, rate: int) -> None:
        """React to a motor that lags behind its trajectory.

        Args:
            now_us: The present time.
            passed_us: How long the motor has lagged behind, but no longer than since the last call.
            milli, rate: The motor's position in thousandths of a count, and its speed in counts per second.
        """

    def lets_go(self, now_us: int, rate: int) -> bool:
        """Return whether a motor whose motion has ended stops following this guide.

        It is called only for motors that do not hold their position at the end.

        Args:
            now_us: The present time.
            rate: The rate of the motor as the firmware measures it, in counts per second.
        """


class ServoMotor:
    """One motor with its encoder, as the Pybricks firmware moves it.

    At first the motor is at rest, and no controller moves it.

    Args:
        tick_hz: Ticks per second.
        law: Which firmware moves it.
        kind: One of `MOTOR_KINDS`.
        axle: A model of the electric motor, which turns it while no controller does.
    """

    __slots__ = (
        "_actuation",
        "_course",
        "_ending",
        "_fastest_deg",
        "_free_dps",
        "_free_us",
        "_hz",
        "_jump_deg",
        "_past",
        "_quiet",
        "_tick",
        "_tick_s",
        "_tick_us",
        "axle",
        "blocked_ticks",
        "control",
        "duty",
        "guide",
        "kind",
        "law",
        "mode",
        "position_deg",
        "sign",
        "speed_dps",
    )

    def __init__(self, tick_hz: int, law: MotorLaw, kind: str, axle: Axle) -> None:
        self._hz = tick_hz
        self._tick_s = 1.0 / tick_hz
        self._tick_us = 1_000_000 // tick_hz
        self.law, self.kind, self.axle = law, kind, axle
        self.mode = STOPPED
        self.position_deg = 0.0
        self.speed_dps = 0.0
        self.blocked_ticks = 0
        self.sign = 1
        """-1 if the program counts against the motor's own direction."""
        self.control = Controller(compute_motor_settings(law, kind))
        """The motor's own controller."""
        self.guide: Guide | None = None
        """The controller or drive base that the motor follows; None while it runs freely."""
        self._ending = Ending.HOLD
        self._course: int | None = 0
        """The motor's position in the program's direction, in half thousandths of a count; None if held back."""
        self.duty: int | None = None
        """The motor's power while it runs freely, in hundredths of a percent; None if it coasts."""
        self._free_us = 0
        self._free_dps = 0.0
        self._jump_deg = 0.0
        self._past: deque[tuple[int, float]] = deque(maxlen=tick_hz * MAX_WINDOW_MS // 1000 + 1)
        """The last ticks in which the motor was not at rest, each with the motor's position."""
        self._tick = self._quiet = 0
        self._limit_speed()

    # The state of the motor that a program can read

    @property
    def follows_base(self) -> bool:
        """Whether the motor follows a drive base, not its own controller."""
        return self.guide not in (None, self.control)

    @property
    def milli(self) -> int:
        """The motor's position in thousandths of a count, in the program's direction."""
        return round((self.position_deg + self._jump_deg) * self.sign * MILLI * COUNTS_PER_DEG)

    @property
    def counts_per_s(self) -> int:
        """The motor's speed in counts per second, in the program's direction."""
        return round(self.speed_dps * self.sign * COUNTS_PER_DEG)

    def find_milli(self, now_us: int) -> int:
        """Return the position that the motor has at a time after the last tick if no obstacle stops it.

        It is in thousandths of a count.
        """
        if self.guide is not None and self._course is not None:
            return self.guide.find_target(now_us, self) // 2
        return self.milli

    def find_counts_per_s(self, now_us: int, window_ms: int = 0) -> int:
        """Return the motor's speed at a time after the last tick, in counts per second.

        Args:
            now_us: The time.
            window_ms: The time before it over which the speed is averaged; 0 for the speed at that time.
        """
        begin_tick = (now_us - window_ms * MS_US) / self._tick_us
        newest = self._tick, self.position_deg
        for (tick, before), (_, after) in pairwise((*self._past, newest) if window_ms else ()):
            if begin_tick < tick + 1:
                turned_deg = max(0.0, begin_tick - tick) * (after - before)
                begin_milli = (before + turned_deg) * self.sign * MILLI * COUNTS_PER_DEG
                return round((self.find_milli(now_us) - begin_milli) / window_ms)
        if self.guide is None:
            return round(self._free_dps * self.sign * COUNTS_PER_DEG)
        return self.counts_per_s if self._course is None else round(self.guide.rate(now_us, self))

    def read_turn(self, now_ns: int) -> tuple[float, float]:
        """Return the position in degrees and the speed in degrees per second that a program reads at a time.

        `now_ns` is that time, after the last tick.
        """
        now_us = now_ns // 1000
        rate = self.find_counts_per_s(now_us, self.control.settings.speed_window_ms)
        deg = self.sign / COUNTS_PER_DEG
        return self.find_milli(now_us) * deg / MILLI, rate * deg

    def measure_start(self, now_us: int) -> Segment:
        """Return the start of a trajectory at a time in µs: position and speed as the motor's encoder shows them."""
        return Segment(
            now_us,
            round(self.find_milli(now_us) / MILLI) * MILLI,
            self.find_counts_per_s(now_us, self.control.settings.speed_window_ms),
            0,
        )

    # Commands

    def set_up(
        self, now_us: int, sign: int, gear_ratio: float, *, keeps_angle: bool = False
    ) -> None:
        """Reset the motor and let it coast, as when a program creates a new `Motor` for its port.

        Args:
            now_us: The present time.
            sign: 1 or -1 for the direction that the program counts as positive.
            gear_ratio: Turns of the motor for one turn of the part that it drives.
            keeps_angle: Whether the position stays; otherwise it becomes 0.
        """
        self.run_freely(now_us, None)
        self.sign = sign
        if not keeps_angle:
            self.position_deg = self._jump_deg = 0.0
            self._past.clear()
        self.control.settings = compute_motor_settings(self.law, self.kind, gear_ratio)

    def follow(self, guide: Guide | None = None, ending: Ending = Ending.HOLD) -> None:
        """Follow a guide from now on.

        Args:
            guide: The guide; None for the motor's own controller, which has just got its trajectory.
            ending: What the motor does at the end of the motion.
        """
        if self.guide is None:
            self._course = round(self.position_deg * self.sign * HALVES_PER_DEG)
        if guide is not None:
            self.control.release()
        self.guide = guide or self.control
        self._ending = ending
        self.control.settles = ending == Ending.HOLD
        timed = guide is None and self.control.timed
        if self.guide.end_us is None:
            self.mode = FOREVER
        elif timed:
            self.mode = TIMED
        else:
            self.mode = POSITION
        self.blocked_ticks = 0
        self.duty = None
        self._jump_deg = 0.0
        if self.control.actuation != self._actuation:
            self._limit_speed()

    @property
    def lets_go(self) -> bool:
        """Whether the motor coasts or brakes after the motion that it follows, instead of holding."""
        return self.guide is not None and self._ending not in (Ending.HOLD, Ending.NONE)

    def _limit_speed(self) -> None:
        """Store the highest speed that the motor reaches with the highest power that its controller allows."""
        self._actuation = self.control.actuation
        self._fastest_deg = find_steady_dps(self.kind, self._actuation) * self._tick_s

    def run_freely(self, now_us: int, duty: int | None) -> None:
        """Stop following a guide, and run with a constant power.

        Args:
            now_us: The present time.
            duty: In hundredths of a percent; 0 brakes, None coasts.
        """
        guide = self.guide
        self._free_us = now_us
        if guide is not None:
            there = self.find_milli(now_us) * self.sign / (MILLI * COUNTS_PER_DEG)
            self._free_dps = self.find_counts_per_s(now_us) * self.sign / COUNTS_PER_DEG
            self._jump_deg = there - self.position_deg
            self.guide = self._course = None
            self.control.release()
        self.duty = None if duty is None else duty * self.sign
        self.blocked_ticks = 0
        self.mode = FOREVER if self.duty or self._free_dps or self._jump_deg else STOPPED

    def set_position(self, now_us: int, milli: int) -> None:
        """Set the value that the motor reports for its present position, in thousandths of a count.

        The present motion ends. The motor then holds the position; under later firmware it holds, brakes or coasts, as
        it would have done at the end of the motion.
        """
        shift = milli - self.find_milli(now_us)
        self._past.clear()
        self.position_deg += shift * self.sign / (MILLI * COUNTS_PER_DEG)
        if self._course is not None:
            self._course += 2 * shift
        if self.guide is not None:
            self.control.hold(now_us, milli)
            windowed = self.control.settings.speed_window_ms
            self.follow(ending=self._ending if windowed else Ending.HOLD)

    # The methods of a `Motor`, which the simulation calls

    @property
    def goal_deg(self) -> float:
        """Position in degrees at which the motor's motion ends; its present position if the motion has no end."""
        guide = self.guide
        end_us = guide.end_us if guide else None
        return (
            self.position_deg
            if guide is None or end_us is None
            else self._convert_to_deg(guide.find_target(end_us, self))
        )

    @property
    def end_tick(self) -> float:
        """The tick at which the motor's present motion ends; `ENDLESS` if it does not end."""
        end_us = self.guide.end_us if self.guide else None
        return ENDLESS if end_us is None else end_us / self._tick_us

    def _convert_to_deg(self, halves: int) -> float:
        return halves * self.sign / HALVES_PER_DEG

    def state(self) -> MotorState:
        """Return the state of the motor before a tick, from which `hold_back` can undo the tick."""
        return self.mode, self.sign, 0.0, self.position_deg

    def hold_back(self, before: MotorState, turned_deg: float, part: float) -> None:
        """Undo the motion of the last tick beyond the point at which an obstacle stopped the wheel.

        Args:
            before: The motor's `state` before the tick.
            turned_deg: How far the wheel would have turned in the tick without the obstacle.
            part: The fraction of the tick's motion that the obstacle allowed, below 1.
        """
        if turned_deg == 0.0:
            return
        position_deg = before[-1]
        self.position_deg = position_deg + (self.position_deg - position_deg) * part
        self.speed_dps *= part
        self._free_dps *= part
        self._course = None
        self.blocked_ticks = (
            self.blocked_ticks + 1 if abs(turned_deg * part) < STANDSTILL_DEG else 0
        )

    @property
    def moving_dps(self) -> float:
        """Current speed of the wheel in degrees per second, negative if it turns backwards."""
        if self.guide is None or self.mode == STOPPED:
            return self.speed_dps
        return self.guide.rate(self._tick * self._tick_us, self) * self.sign / COUNTS_PER_DEG

    @property
    def counting_dps(self) -> float:
        """Current speed of the encoder's count in degrees per second."""
        return self.speed_dps

    @property
    def aim_dps(self) -> float:
        """Speed of the wheel at the end of the present segment, in degrees per second; negative backwards."""
        guide = self.guide
        if guide is None:
            return self.speed_dps
        end_us = guide.find_segment_end_us(self._tick * self._tick_us)
        now_us = self._tick * self._tick_us if end_us is None else end_us
        return guide.rate(now_us, self) * self.sign / COUNTS_PER_DEG

    @property
    def resting(self) -> bool:
        """Whether the motor stays unchanged until its next command."""
        return self.mode == STOPPED

    @property
    def ramping_ticks(self) -> int:
        """The last result of `count_quiet_ticks`, 0 while the motor is stopped.

        So a motor that follows a trajectory always counts as one whose speed still changes.
        """
        return 0 if self.mode == STOPPED else self._quiet

    def count_quiet_ticks(self, tick: int) -> int:
        """Return in how many ticks after `tick` the motor rests, or only follows one segment of its trajectory."""
        self._tick, self._quiet = tick, self._count_following_ticks(tick)
        return self._quiet

    def _count_following_ticks(self, tick: int) -> int:
        if self.mode == STOPPED:
            return ENDLESS
        guide = self.guide
        now_us = tick * self._tick_us
        if guide is None or self._course is None or not self._can_follow(guide, now_us):
            return 0
        end_us = guide.find_segment_end_us(now_us)
        if end_us is not None:
            return max(0, (end_us - 1) // self._tick_us - tick)
        return 0 if guide.end_us is not None else ENDLESS

    def _can_follow(self, guide: Guide, now_us: int) -> bool:
        """Return whether the motor is fast enough to follow a guide in the next tick, and then to the segment's end."""
        assert self._course is not None
        next_deg = (
            abs(guide.find_target(now_us + self._tick_us, self) - self._course) / HALVES_PER_DEG
        )
        fastest_dps = max(abs(self.moving_dps), abs(self.aim_dps))
        return next_deg <= self._fastest_deg and fastest_dps * self._tick_s <= self._fastest_deg

    def glide_evenly(self, ticks: int) -> EvenGlide:
        """Return the motion of a motor at rest over several ticks: no rotation, and always the same position."""
        return EvenGlide(0.0, repeat(self.position_deg, ticks))

    def glide(self, ticks: int) -> Glide:
        """Advance the motor by several ticks, all in one segment of its trajectory; return its motion in each."""
        if self.mode == STOPPED or self.guide is None or self._course is None:
            return Glide([0.0] * ticks, [self.position_deg] * ticks)
        tick_us = self._tick_us
        times_us = range((self._tick + 1) * tick_us, (self._tick + ticks + 1) * tick_us, tick_us)
        halves = [self.guide.find_target(time_us, self) for time_us in times_us]
        turns = [
            self._convert_to_deg(after - before)
            for before, after in pairwise([self._course, *halves])
        ]
        positions = [self._convert_to_deg(half) for half in (self._course, *halves)]
        self._past.extend(enumerate(positions[:-1], self._tick))
        self._course = halves[-1]
        self._tick = self._tick + ticks
        self.position_deg = positions[-1]
        self.speed_dps = turns[-1] * self._hz
        return Glide(turns, positions[1:])

    def step(self, tick: int, noise_dps: float) -> float:
        """Run the tick `tick` with noise added to the motor's speed; return the rotation of the wheel in degrees."""
        self._tick = tick
        if self.mode == STOPPED:
            return 0.0
        self._past.append((tick - 1, self.position_deg))
        now_us = tick * self._tick_us
        guide = self.guide
        if guide is None:
            return self._run_freely(now_us)
        if self._course is None:
            if guide is self.control and self.control.has_ended(now_us):
                # A timed motion has no goal: it ends at the position that the motor has now.
                self.control.hold(now_us, self.milli)
                self._end(now_us)
                return 0.0
            guide.note_lag(now_us - self._tick_us, self._tick_us, self.milli, self.counts_per_s)
        halves = guide.find_target(now_us, self)
        if self._course is not None:
            turned = (halves - self._course) * self.sign / HALVES_PER_DEG
            if not noise_dps and -self._fastest_deg <= turned <= self._fastest_deg:
                self._course, self.position_deg = halves, halves * self.sign / HALVES_PER_DEG
                self.speed_dps = turned * self._hz
                if turned == 0.0 and (end_us := guide.end_us) is not None and now_us >= end_us:
                    self._end(now_us)
                return turned
        return self._catch_up(halves, noise_dps)

    def _catch_up(self, halves: int, noise_dps: float) -> float:
        """Turn the motor in one tick as far as it can towards a target position; return the rotation in degrees.

        Args:
            halves: The target position, in half thousandths of a count.
            noise_dps: The noise that is added to the motor's speed.
        """
        fastest_deg, wanted_deg = self._fastest_deg, self._convert_to_deg(halves)
        turned = max(-fastest_deg, min(fastest_deg, wanted_deg - self.position_deg))
        reached = turned == wanted_deg - self.position_deg and not noise_dps
        turned += noise_dps * self._tick_s if turned else 0.0
        self.position_deg = wanted_deg if reached else self.position_deg + turned
        self.speed_dps = turned * self._hz
        self._course = halves if reached else None
        return turned

    def _end(self, now_us: int) -> None:
        """End the motor's motion: the motor stands still, and holds, brakes or coasts, as its command says.

        Do nothing if the motor has to follow its guide for longer, until it is at rest.
        """
        guide = self.guide
        holds = self._ending == Ending.HOLD
        rate = self.measure_start(now_us).rate
        if not holds and guide is not None and not guide.lets_go(now_us, rate):
            return
        self.mode = STOPPED
        self.speed_dps = 0.0
        self.blocked_ticks = 0
        if not holds and guide is not None:
            self.control.release()
            self.guide = None
            self._free_dps = 0.0
            self.duty = 0 if self._ending in BRAKING else None

    def _run_freely(self, now_us: int) -> float:
        """Run one tick of the motor without a guide; return its rotation in degrees."""
        axle = self.axle
        left_ns = min(self._tick_us, now_us - self._free_us) * 1000.0
        begin_deg = axle.angle_deg
        axle.speed_dps = self._free_dps
        axle.power(None if self.duty is None else self.duty / PER_PERCENT)
        while left_ns:
            left_ns = axle.advance(left_ns)
        turned = self._jump_deg + axle.angle_deg - begin_deg
        self._jump_deg = 0.0
        self._free_dps = axle.speed_dps
        self.position_deg += turned
        self.speed_dps = axle.speed_dps
        if not (turned or axle.speed_dps or self.duty):
            self.mode = STOPPED
        return turned
