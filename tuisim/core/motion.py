"""Motion: motors and robot moved on in whole ticks, each of which is recorded.

`advance` gives the same state to the last bit however the ticks are divided among
calls: stretches in which nothing happens but motion are done in tight loops, and every
loop does the same floating-point operations in the same order as a single tick.
"""

from __future__ import annotations

from math import ceil, cos, degrees, radians, sin
from struct import Struct

from tuisim.core import motors
from tuisim.core.drive import mm_per_degree
from tuisim.core.motors import Motor, MotorState, ramped, top_speed_dps
from tuisim.core.noise import wheel_noise
from tuisim.core.sink import Buffer, TickSink
from tuisim.core.solid import Solids
from tuisim.core.spec import RunSpec
from tuisim.core.state import FLAG_LEFT_RUNNING, FLAG_PEN_DOWN, FLAG_RIGHT_RUNNING, TICK_RECORD

STALL_MS = 100
"""A running motor that stands still for longer is stalled (EV3 motor driver)."""

ROOM_TICKS = 256
"""The sink is asked for room for so many records beyond those at hand."""

LOOK_TICKS = 4
"""Solid things are looked at anew when the way known to be free is shorter than that of so many ticks."""

FEW_TICKS = 3
"""Up to so many ticks, setting up a tight loop costs more than it saves."""

_FLOAT32 = Struct("<f")


def float32(value: float) -> float:
    """Return `value` as the telemetry stores it, so that viewers and programs see the same."""
    return float(_FLOAT32.unpack(_FLOAT32.pack(value))[0])


class Motion:
    """Robot and motors of one run.

    Args:
        spec: Robot, world, profile and seed.
        sink: Gets one record a tick, beginning with tick 0.
    """

    __slots__ = (
        "_buffer", "_early", "_hz", "_left_dps", "_longest_mm", "_mm_per_deg", "_ramp_step", "_right_dps", "_room_end",
        "_sink", "_solids", "_spacing_mm", "_tick_s", "_whole", "actions", "changed", "gyro_zero_deg", "heading_deg",
        "left", "line", "noise", "pen_down", "right", "spec", "tick", "x_mm", "y_mm",
    )  # fmt: skip

    def __init__(self, spec: RunSpec, sink: TickSink) -> None:
        self.spec = spec
        self._sink = sink
        self._hz = spec.profile.tick_hz
        self._tick_s = 1.0 / self._hz
        self._mm_per_deg = mm_per_degree(spec.robot)
        self._ramp_step = 5000.0 / spec.robot.weight / self._hz if spec.robot.weight else 0.0
        self._spacing_mm = spec.robot.wheel_spacing_mm
        self._whole = spec.profile.round_forward_speeds
        self._early = 0.5 if spec.profile.halfway_heading else 0.0
        """Which part of a tick's turn counts already for the way of that tick."""
        self._solids = Solids(spec.world, spec.robot, self._early) if spec.world.solid else None
        if self._solids is not None:
            # A wheel at full speed forwards and the other backwards.
            fastest = max(top_speed_dps(motor.kind, spec.profile) for motor in spec.robot.wheel_motors)
            farthest = fastest * self._tick_s * self._mm_per_deg
            self._longest_mm = farthest * (1 + 2 * self._solids.reach_mm / self._spacing_mm)
        self.tick = 0
        start = spec.world.start
        self.x_mm, self.y_mm, self.heading_deg = start.x_mm, start.y_mm, start.heading_deg
        self.gyro_zero_deg = float32(start.heading_deg)
        left, right = spec.robot.wheel_motors
        self.left = Motor(top_speed_dps(left.kind, spec.profile))
        self.right = Motor(top_speed_dps(right.kind, spec.profile))
        self.noise = spec.world.noise
        self.pen_down = spec.robot.pen.down
        self.line = 0
        """Source line that lets the time pass, for the record."""
        self.actions = 0
        """User actions applied so far."""
        self.changed = False
        """Set when a motor ends a move by itself; the caller clears it."""
        self._left_dps = self._right_dps = 0.0
        self._buffer: Buffer = sink.room(ROOM_TICKS)
        self._room_end = ROOM_TICKS
        """How many records the buffer has room for."""
        TICK_RECORD.pack_into(self._buffer, 64, *self._fields())
        sink.publish(1)

    def advance(self, ticks: int, until_change: bool = False) -> int:
        """Do some ticks.

        Args:
            ticks: How many.
            until_change: Come back early when a motor ends a move.

        Returns:
            How many were done.
        """
        if ticks == 1:
            self.tick_once()
            return 1
        done = 0
        while done < ticks:
            quiet = self._quiet_ticks(ticks - done) if ticks - done > FEW_TICKS else 0
            if quiet > 0:
                self._glide(quiet)
                done += quiet
            else:
                self.tick_once()
                done += 1
                if until_change and self.changed:
                    break
        return done

    def _quiet_ticks(self, most: int) -> int:
        """For how many ticks nothing but ramps and motion goes on, at most `most`."""
        if self.noise.motor:
            return 0
        halved = self.spec.profile.halve_position_moves
        return min(
            most,
            self.left.quiet_ticks(self.tick, self._tick_s, halved),
            self.right.quiet_ticks(self.tick, self._tick_s, halved),
            self._clear_ticks(most),
        )

    def tick_once(self) -> None:
        """Do one tick in full: the rule that the loops below abbreviate."""
        count = self._sink.count
        # Before anything moves: where there is no room for its record, there is no tick.
        buffer = self._buffer if count < self._room_end else self._make_room(1)
        self.tick = tick = self.tick + 1
        left, right, tick_s, noise = self.left, self.right, self._tick_s, self.noise.motor
        before, aside_mm = None, None
        if self._solids is not None and self._solids.left_of_room_mm(self._pose()) < self._longest_mm:
            before = left.state(), right.state()
        # A motor that just goes on needs only the ramp of the rules of `step`; most ticks are such.
        if left.mode == motors.FOREVER and not noise:
            if left.speed_dps != left.target_dps:
                step = left.ramp_step(self._ramp_step, tick_s) if left.slowest_ramp_dps2 else self._ramp_step
                left.speed_dps = ramped(left.speed_dps, left.target_dps, step, self._whole)
            left_deg = left.speed_dps * left.sign * tick_s
            left.position_deg += left_deg
        else:
            left_deg = self._step(left, 0)
        if right.mode == motors.FOREVER and not noise:
            if right.speed_dps != right.target_dps:
                step = right.ramp_step(self._ramp_step, tick_s) if right.slowest_ramp_dps2 else self._ramp_step
                right.speed_dps = ramped(right.speed_dps, right.target_dps, step, self._whole)
            right_deg = right.speed_dps * right.sign * tick_s
            right.position_deg += right_deg
        else:
            right_deg = self._step(right, 1)
        if before is not None:
            left_deg, right_deg, aside_mm = self._obstructed(before, left_deg, right_deg)
        left_mm, right_mm = left_deg * self._mm_per_deg, right_deg * self._mm_per_deg
        turned = degrees((right_mm - left_mm) / self._spacing_mm)
        heading = radians(self.heading_deg + turned * self._early)
        forward = (left_mm + right_mm) / 2
        self.x_mm += forward * cos(heading)
        self.y_mm += forward * sin(heading)
        self.heading_deg += turned
        if aside_mm is not None:
            self.x_mm, self.y_mm = self.x_mm + aside_mm[0], self.y_mm + aside_mm[1]
        self._left_dps, self._right_dps = left_deg * self._hz, right_deg * self._hz
        flags = (left.mode and FLAG_LEFT_RUNNING) | (right.mode and FLAG_RIGHT_RUNNING)
        flags |= self.pen_down and FLAG_PEN_DOWN
        TICK_RECORD.pack_into(
            buffer, 64 + 64 * count,
            tick, self.line, self.x_mm, self.y_mm, self.heading_deg, left.position_deg, right.position_deg,
            self._left_dps, self._right_dps, self.gyro_zero_deg, flags, self.actions & 0xFFFF,
        )  # fmt: skip
        self._sink.publish(count + 1)

    def _clear_ticks(self, most: int) -> int:
        """For how many ticks, at most `most`, nothing solid can be met by a robot that is not told anything new."""
        if self._solids is None:
            return most
        left, right = self.left, self.right
        if left.blocked_ticks or right.blocked_ticks:
            return 0
        left_ends = (left.moving_dps, left.target_dps * left.sign if left.mode else 0.0)
        right_ends = (right.moving_dps, right.target_dps * right.sign if right.mode else 0.0)
        per_dps = self._tick_s * self._mm_per_deg
        straight, turn = 0, 0.0
        if left_ends == right_ends and left_ends[0] * left_ends[1] >= 0:
            straight = 1 if sum(left_ends) > 0 else -1
        else:
            turn = max(max(right_ends) - min(left_ends), max(left_ends) - min(right_ends)) * per_dps / self._spacing_mm
        fastest = max(map(abs, (*left_ends, *right_ends))) * per_dps
        way = fastest + turn * self._solids.reach_mm
        if way == 0.0:
            return most
        pose = self._pose()
        free = self._solids.free_way_mm(pose, way * min(most, LOOK_TICKS), straight)
        # Where nothing stands in the way it is infinite.
        return most if free >= way * most else int(free / way)

    def _pose(self) -> tuple[float, float, float]:
        return self.x_mm, self.y_mm, self.heading_deg

    def _obstructed(
        self, before: tuple[MotorState, MotorState], left_deg: float, right_deg: float
    ) -> tuple[float, float, tuple[float, float] | None]:
        """Take back what something solid does not allow of a tick.

        Returns:
            The degrees that are left, and how far the robot is pushed aside along x and y.
        """
        left_mm, right_mm = left_deg * self._mm_per_deg, right_deg * self._mm_per_deg
        if self._solids is None or (left_mm == 0.0 and right_mm == 0.0):
            return left_deg, right_deg, None
        turn_deg = degrees((right_mm - left_mm) / self._spacing_mm)
        pose = self._pose()
        part, aside_mm = self._solids.leeway(pose, (left_mm + right_mm) / 2, turn_deg)
        if part == 1.0:
            self.left.blocked_ticks = self.right.blocked_ticks = 0
            return left_deg, right_deg, aside_mm
        for motor, state, turned_deg in zip((self.left, self.right), before, (left_deg, right_deg), strict=True):
            motor.hold_back(state, turned_deg, part)
            if motor.blocked_ticks == self.stall_ticks:
                self.changed = True
        return left_deg * part, right_deg * part, aside_mm

    @property
    def stall_ticks(self) -> int:
        """A motor that has been kept from turning for so many ticks is stalled."""
        return STALL_MS * self._hz // 1000 + 1

    def _step(self, motor: Motor, side: int) -> float:
        """Let one motor do the present tick; 0 is the left one. Returns degrees turned."""
        noise_dps = 0.0
        if self.noise.motor:
            noise_dps = wheel_noise(self.spec.seed, self.tick)[side] * self.noise.motor
        before = motor.mode
        turned = motor.step(self.tick, self.spec.profile, self._ramp_step, self._tick_s, noise_dps)
        if motor.mode != before:
            self.changed = True
        return turned

    def _fields(self) -> tuple[float, ...]:
        """The present tick's record."""
        return (
            self.tick, self.line, self.x_mm, self.y_mm, self.heading_deg,
            self.left.position_deg, self.right.position_deg, self._left_dps, self._right_dps,
            self.gyro_zero_deg, self._flags(), self.actions & 0xFFFF,
        )  # fmt: skip

    def _flags(self) -> int:
        return (
            (FLAG_LEFT_RUNNING if self.left.mode else 0)
            | (FLAG_RIGHT_RUNNING if self.right.mode else 0)
            | (FLAG_PEN_DOWN if self.pen_down else 0)
        )

    def _make_room(self, ticks: int) -> Buffer:
        """Return a buffer with room for so many more records, and often for some beyond."""
        end = self._sink.count + ticks
        if end > self._room_end:
            self._buffer, self._room_end = self._sink.room(ticks + ROOM_TICKS), end + ROOM_TICKS
        return self._buffer

    def _glide(self, ticks: int) -> None:
        """Do ticks in which only the ramps and the motion go on: the hottest loop."""
        while ticks:
            ramping = self._ramping_ticks(ticks)
            if ramping:
                self._glide_ramping(ramping)
            else:
                self._glide_steady(ticks)
            ticks -= ramping or ticks

    def _ramping_ticks(self, most: int) -> int:
        """How many ticks until both motors have reached their speed, at most `most`."""
        longest = 0
        for motor in (self.left, self.right):
            if motor.mode and motor.speed_dps != motor.target_dps:
                step = motor.ramp_step(self._ramp_step, self._tick_s)
                longest = max(longest, ceil(abs(motor.target_dps - motor.speed_dps) / step) if step else 1)
        return min(most, longest)

    def _glide_ramping(self, ticks: int) -> None:
        buffer = self._make_room(ticks)
        left, right, tick_s = self.left, self.right, self._tick_s
        mm_per_deg, spacing = self._mm_per_deg, self._spacing_mm
        left_speeds, left_counts = self._ahead(left, ticks)
        right_speeds, right_counts = self._ahead(right, ticks)
        left_sign, right_sign, left_at, right_at = left.sign, right.sign, left.position_deg, right.position_deg
        line, zero, flags, actions = self.line, self.gyro_zero_deg, self._flags(), self.actions & 0xFFFF
        x, y, heading, hz = self.x_mm, self.y_mm, self.heading_deg, self._hz
        pack_into = TICK_RECORD.pack_into
        across = up = 0.0
        faced, early = False, self._early
        sink = self._sink
        at = 64 + 64 * sink.count
        left_deg = right_deg = 0.0
        for tick, left_speed, right_speed in zip(
            range(self.tick + 1, self.tick + ticks + 1), left_speeds, right_speeds, strict=True
        ):
            left_deg, right_deg = left_speed * left_sign * tick_s, right_speed * right_sign * tick_s
            left_at += left_deg if left_counts is None else left_counts * left_deg + left.counts_on_dps * tick_s
            right_at += right_deg if right_counts is None else right_counts * right_deg + right.counts_on_dps * tick_s
            left_mm, right_mm = left_deg * mm_per_deg, right_deg * mm_per_deg
            forward = (left_mm + right_mm) / 2
            if left_mm != right_mm:
                turned = degrees((right_mm - left_mm) / spacing)
                turn = radians(heading + turned * early)
                x += forward * cos(turn)
                y += forward * sin(turn)
                heading += turned
                faced = False
            else:
                if not faced:
                    turn = radians(heading)
                    across, up, faced = cos(turn), sin(turn), True
                x += forward * across
                y += forward * up
            pack_into(
                buffer, at, tick, line, x, y, heading, left_at, right_at, left_deg * hz, right_deg * hz,
                zero, flags, actions,
            )  # fmt: skip
            at += 64
        self.tick += ticks
        self.x_mm, self.y_mm, self.heading_deg = x, y, heading
        left.position_deg, right.position_deg = left_at, right_at
        self._left_dps, self._right_dps = left_deg * hz, right_deg * hz
        sink.publish(sink.count + ticks)

    def _ahead(self, motor: Motor, ticks: int) -> tuple[list[float], float | None]:
        """Let a motor's ramp run ahead.

        Returns:
            Its speed in each tick, and how often the encoder counts each step (None: once).
        """
        if motor.mode == motors.STOPPED:
            return [0.0] * ticks, 0.0
        profile = self.spec.profile
        step = motor.ramp_step(self._ramp_step, self._tick_s)
        speeds = motor.ramp_ahead(ticks, step, profile.round_forward_speeds)
        return speeds, 2.0 if profile.halve_position_moves and motor.mode == motors.POSITION else None

    def _glide_steady(self, ticks: int) -> None:
        left, right, tick_s, halved = self.left, self.right, self._tick_s, self.spec.profile.halve_position_moves
        left_deg, right_deg = left.moving_dps * tick_s, right.moving_dps * tick_s
        left_count = left_deg if left.mode else left.counts_on_dps * tick_s
        right_count = right_deg if right.mode else right.counts_on_dps * tick_s
        if halved and left.mode == motors.POSITION:
            left_count = 2 * left_deg
        if halved and right.mode == motors.POSITION:
            right_count = 2 * right_deg
        left_mm, right_mm = left_deg * self._mm_per_deg, right_deg * self._mm_per_deg
        forward = (left_mm + right_mm) / 2
        turned = degrees((right_mm - left_mm) / self._spacing_mm)
        x, y, heading = self.x_mm, self.y_mm, self.heading_deg
        left_at, right_at = left.position_deg, right.position_deg
        line, zero, flags, actions = self.line, self.gyro_zero_deg, self._flags(), self.actions & 0xFFFF
        left_dps, right_dps = left_deg * self._hz, right_deg * self._hz
        pack_into = TICK_RECORD.pack_into
        sink = self._sink
        buffer, at = self._make_room(ticks), 64 + 64 * sink.count
        early = turned * self._early
        turn = radians(heading + early)
        across, up = forward * cos(turn), forward * sin(turn)
        for tick in range(self.tick + 1, self.tick + ticks + 1):
            left_at += left_count
            right_at += right_count
            x += across
            y += up
            if turned:
                heading += turned
                turn = radians(heading + early)
                across, up = forward * cos(turn), forward * sin(turn)
            pack_into(
                buffer, at, tick, line, x, y, heading, left_at, right_at, left_dps, right_dps, zero, flags, actions
            )
            at += 64
        self.tick += ticks
        self.x_mm, self.y_mm, self.heading_deg = x, y, heading
        left.position_deg, right.position_deg = left_at, right_at
        self._left_dps, self._right_dps = left_dps, right_dps
        sink.publish(sink.count + ticks)
