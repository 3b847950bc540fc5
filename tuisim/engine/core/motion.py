"""Motion: advances motors and robot in whole ticks by the profile's motor law, and records each tick.

`advance` gives the same state to the last bit however the ticks are divided among calls: ticks in which only the motion
goes on run in fast loops, and every loop does the same floating-point operations in the same order as a single tick.
"""

from __future__ import annotations

from math import degrees
from typing import TYPE_CHECKING, assert_never

from tuisim.engine.core.brick_motor import BrickMotor
from tuisim.engine.core.browser_motor import BrowserMotor
from tuisim.engine.core.collision import Solids
from tuisim.engine.core.drift import (
    MAX_TIMES,
    build_gyro,
    build_slipping_wheels,
    can_strain_gyro,
    find_drift,
)
from tuisim.engine.core.drive import (
    BrickDrive,
    BrowserDrive,
    Drive,
    Glide,
    Records,
    compute_mm_per_degree,
)
from tuisim.engine.core.driver.jiffies import draw_jiffies
from tuisim.engine.core.driver.simulated import SimulatedMotor, build_axle, build_motor
from tuisim.engine.core.end_stops import build_start_flags
from tuisim.engine.core.motor_columns import MotorRecorder, MotorSink
from tuisim.engine.core.motors import (
    POSITION,
    STANDSTILL_DEG,
    Motor,
    MotorState,
    find_top_speed_dps,
)
from tuisim.engine.core.noise import draw_noise, draw_noises
from tuisim.engine.core.profile import NS_PER_S, MotorLaw
from tuisim.engine.core.servo.motor import ServoMotor
from tuisim.engine.core.tick_record import (
    FLAG_LEFT_RUNNING,
    FLAG_PEN_DOWN,
    FLAG_RIGHT_RUNNING,
    TICK_RECORD,
    Buffer,
    TickSink,
)

if TYPE_CHECKING:
    from tuisim.engine.core.spec import RunSpec
    from tuisim.engine.core.state import MotorValues

STALL_MS = 100
"""A running motor that does not turn for longer than this is stalled (EV3 motor driver)."""

ROOM_TICKS = 256
"""Number of records beyond the current ones for which space is requested from the sink."""

CHECK_TICKS = 4
"""Obstacles are checked again when the way known to be free is shorter than the robot's way in this many ticks."""

MAX_SINGLE_TICKS = 3
"""Up to this number of ticks are run one by one: for so few, setting up a tight loop costs more than it saves."""


def compute_stall_ticks(tick_hz: int) -> int:
    """Return the number of ticks without motion after which a running motor is stalled."""
    return STALL_MS * tick_hz // 1000 + 1


WEIGHT_DPS2 = 5000.0
"""Acceleration of a motor in degrees per second squared, multiplied by the robot's weight."""


def compute_weight_step(spec: RunSpec) -> float:
    """Return the largest change of a motor's speed in one tick, in degrees per second; 0 is unlimited."""
    return WEIGHT_DPS2 / spec.robot.weight / spec.profile.tick_hz if spec.robot.weight else 0.0


def create_motor(spec: RunSpec, kind: str, *, free: bool = False) -> Motor:
    """Return a motor of one of `MOTOR_KINDS`, in its initial state.

    Args:
        spec: The run, whose profile says which motor law applies.
        kind: The kind of motor.
        free: Whether the motor drives no wheel.
    """
    profile = spec.profile
    step = compute_weight_step(spec)
    fastest_dps = find_top_speed_dps(kind, spec.profile)
    match profile.motor_law:
        case MotorLaw.BRICK:
            return BrickMotor(profile.tick_hz, step, fastest_dps)
        case MotorLaw.EV3DEV:
            return build_motor(spec, kind, free=free)
        case MotorLaw.NBEV3DEVSIM:
            return BrowserMotor(profile.tick_hz, step, fastest_dps)
        case MotorLaw.PYBRICKS | MotorLaw.PYBRICKS_4:
            axle = build_axle(spec, kind, free=free)
            return ServoMotor(profile.tick_hz, profile.motor_law, kind, axle)
        case _:
            assert_never(profile.motor_law)


def build_drive(spec: RunSpec) -> Drive:
    """Return the drive of a run's robot, at its initial pose."""
    is_browser = spec.profile.motor_law is MotorLaw.NBEV3DEVSIM
    drive = BrowserDrive if is_browser else BrickDrive
    return drive(spec.robot, spec.world.start, compute_early(spec))


def compute_early(spec: RunSpec) -> float:
    """Return the fraction of a tick's turn that already applies to the motion of that tick."""
    return 0.5 if spec.profile.halfway_heading else 0.0


class Motion:
    """The robot's pose and motors in one run, which are advanced in whole ticks.

    Args:
        spec: Robot, world, profile and seed.
        sink: Receives one record per tick, starting with tick 0.
        others: The motors that drive no wheel.
    """

    __slots__ = (
        "_buffer",
        "_driven",
        "_hz",
        "_is_placed",
        "_left_dps",
        "_left_mm_per_deg",
        "_longest_mm",
        "_motor_recorder",
        "_right_dps",
        "_right_mm_per_deg",
        "_roll",
        "_room_end",
        "_sink",
        "_slipping",
        "_solids",
        "_spacing_mm",
        "_strains_gyro",
        "_tick_s",
        "actions",
        "changed",
        "changed_ns",
        "drive",
        "left",
        "line",
        "motors",
        "noise",
        "pen_down",
        "press_flags",
        "right",
        "spec",
        "stall_ticks",
        "tick",
    )

    def __init__(self, spec: RunSpec, sink: TickSink, others: tuple[Motor, ...]) -> None:
        self._hz = spec.profile.tick_hz
        self._tick_s = 1.0 / self._hz
        self.stall_ticks = compute_stall_ticks(self._hz)
        self._left_mm_per_deg, self._right_mm_per_deg = compute_mm_per_degree(spec.robot)
        self._spacing_mm = spec.robot.wheel_spacing_mm
        self._build_solids(spec)
        self.tick = 0
        self.left = create_motor(spec, spec.robot.left_motor)
        self.right = create_motor(spec, spec.robot.right_motor)
        self.motors: tuple[Motor, ...] = self.left, self.right, *others
        """All motors, in the order of `RobotSpec.motors`."""
        self.pen_down = spec.robot.pen.down
        self.press_flags = build_start_flags(spec.robot)
        """End stops that motors are at, and touch sensors that a hand presses: the bits of `PRESS_FLAGS`."""
        self.line = 0
        """Source line that spends the simulated time, for the record."""
        self.actions = 0
        """Number of user actions applied."""
        self.changed = False
        """Whether a motor has ended a move, or a driver noticed a change of state, since the caller last cleared this
        flag."""
        self._left_dps = self._right_dps = 0.0
        self._driven: tuple[SimulatedMotor, ...] = ()
        """The motors with a driver, which notices changes of their states late."""
        self.changed_ns = 0
        """Time in ns at which a driver last noticed that its motor's state had changed."""
        self._begin(spec, sink)

    def _build_solids(self, spec: RunSpec) -> None:
        """Prepare the walls and obstacles that the robot can meet."""
        self._solids = (
            Solids(spec.world, spec.robot, compute_early(spec)) if spec.world.solid else None
        )
        if self._solids is not None:
            # A point of the body moves farthest if one wheel turns forwards at full speed, and the other backwards.
            fastest = max(
                find_top_speed_dps(motor.kind, spec.profile) for motor in spec.robot.wheel_motors
            )
            farthest = fastest * self._tick_s * abs(self._left_mm_per_deg)
            farthest *= 1 if find_drift(spec).is_none else MAX_TIMES
            self._longest_mm = farthest * (1 + 2 * self._solids.reach_mm / self._spacing_mm)

    def _begin(self, spec: RunSpec, sink: TickSink, motor_sink: MotorSink | None = None) -> None:
        """Set the state in which a run begins, except for what is the same in all runs of this robot in this world.

        Args:
            spec: The run.
            sink: Receives the tick records.
            motor_sink: Receives the values of the motors' drivers; None without drivers, or if they are not recorded.
        """
        self.spec = spec
        self._sink = sink
        self.noise = spec.world.noise
        self.drive = build_drive(spec)
        """The robot's pose and how its wheels change it."""
        self._slipping = build_slipping_wheels(spec)
        gyro = build_gyro(spec, self.drive)
        self._roll = self.drive.roll if gyro is None else gyro.roll
        """Moves the robot, and what its gyro senses."""
        self._strains_gyro = can_strain_gyro(spec)
        self._is_placed = False
        """Whether the robot was put elsewhere after the last tick. The next one frees its wheels, because their drivers
        may have advanced already.
        """
        self._start_clocks()
        self._buffer: Buffer = sink.reserve(ROOM_TICKS)
        self._room_end = ROOM_TICKS
        """Number of records for which the buffer has space."""
        self._motor_recorder = MotorRecorder(self._driven, motor_sink)
        self._motor_recorder.make_room(ROOM_TICKS)
        TICK_RECORD.pack_into(self._buffer, 64, *self._build_record())
        self._publish(1)

    def _start_clocks(self) -> None:
        """Start the drivers' clocks at an instant that depends on the seed."""
        self._driven = tuple(motor for motor in self.motors if isinstance(motor, SimulatedMotor))
        if self._driven:
            jiffies = draw_jiffies(self.spec.seed)
            for motor in self._driven:
                motor.start_clock(jiffies)

    @property
    def notices(self) -> bool:
        """Whether the motors have drivers.

        A driver notices a change of its motor's state only at its next check, so programs learn of it late.
        """
        return bool(self._driven)

    @property
    def motor_values(self) -> tuple[MotorValues, ...]:
        """The values of all motors' drivers that were recorded at the last tick; empty without drivers."""
        return self._motor_recorder.read_values(self._sink.count - 1)

    def _publish(self, ticks: int) -> None:
        """Make the records of some more ticks visible to readers; the drivers' values are the same in all of them."""
        count = self._sink.count
        self._motor_recorder.record(count, ticks)
        self._sink.publish(count + ticks)

    def compute_due_ns(self, tick: int) -> int:
        """Return when a tick is due, in ns from the start; the same as `profile.compute_due_ns`, but faster."""
        return -(-tick * NS_PER_S // self._hz)

    def find_next_change_ns(self, now_ns: int) -> int:
        """Return when a program can next notice a change of a motor, in ns.

        It is the end of the current tick, or the next check of a motor's driver if that comes earlier.
        """
        looks_ns = [motor.next_look_ns for motor in self._driven if motor.next_look_ns > now_ns]
        return min([self.compute_due_ns(self.tick + 1), *looks_ns])

    def notice_change(self) -> bool:
        """Run the drivers' checks up to the end of the next tick; return whether one has noticed a change."""
        end_ns = self.compute_due_ns(self.tick + 1)
        for motor in self._driven:
            if motor.next_look_ns <= end_ns:
                motor.run_until(motor.find_last_look_ns(end_ns))
            if motor.noticed_ns > self.changed_ns:
                self.changed_ns = motor.noticed_ns
                self.changed = True
        return self.changed

    def advance(self, ticks: int, until_change: bool = False) -> int:
        """Advance the simulation by ticks, and return how many ticks have been run.

        Args:
            ticks: Number of ticks.
            until_change: Whether to return earlier, as soon as a motor has ended a move.
        """
        if ticks == 1 and not until_change:
            self.tick_once()
            return 1
        done = 0
        while done < ticks:
            if until_change and self._driven and self.notice_change():
                break
            quiet = self._count_quiet_ticks(ticks - done) if ticks - done > MAX_SINGLE_TICKS else 0
            if quiet > 0:
                self._glide(quiet)
                done += quiet
            else:
                self.tick_once()
                done += 1
                if until_change and self.changed:
                    break
        return done

    def _count_quiet_ticks(self, most: int) -> int:
        """Return the number of ticks, at most `most`, in which only the motors' ramps and the robot's pose change."""
        left, right = self.left, self.right
        if self._is_placed:
            return 0
        if self._slipping is not None or (self.noise.motor and not self._can_glide_with_noise()):
            return 0
        if self._strains_gyro and not (left.resting and right.resting):
            return 0
        quiet = min(left.count_quiet_ticks(self.tick), right.count_quiet_ticks(self.tick))
        return min(most, quiet, self._clear_ticks(most)) if quiet > 0 else 0

    def _can_glide_with_noise(self) -> bool:
        """Return whether several ticks of motors with noise can be computed together.

        They can if the world has no obstacles, and no wheel's motor moves to a position.
        """
        left, right = self.left, self.right
        if self._solids is not None or left.mode == POSITION or right.mode == POSITION:
            return False
        return isinstance(left, BrickMotor) and isinstance(right, BrickMotor)

    def tick_once(self) -> None:
        """Advance the simulation by one tick. `_glide`, which advances several together, gives the same results."""
        count = self._sink.count
        # Reserve space before anything moves: if there is none, the tick does not happen.
        buffer = self._buffer if count < self._room_end else self._make_room(1)
        self.tick = tick = self.tick + 1
        left = self.left
        right = self.right
        drive = self.drive
        before = None
        aside_mm = None
        slipping = self._slipping
        if self._solids is not None and self._solids.remaining_mm(self._pose()) < self._longest_mm:
            before = left.state(), right.state()
        noise = self.noise.motor
        left_noise, right_noise = draw_noise(self.spec.seed, tick, noise) if noise else (0.0, 0.0)
        modes = None if self._driven else (left.mode, right.mode)
        left_deg, right_deg = left.step(tick, left_noise), right.step(tick, right_noise)
        if modes is not None and modes != (left.mode, right.mode):
            self.changed = True
        left_roll, right_roll = left_deg, right_deg
        if slipping is not None:
            left_roll, right_roll = slipping.turn_deg(tick, left_deg, right_deg)
        if before is not None:
            part, aside_mm = self._undo_blocked(before, left_roll, right_roll)
            left_deg, right_deg = left_deg * part, right_deg * part
            left_roll, right_roll = left_roll * part, right_roll * part
        self._roll(left_roll, right_roll)
        if aside_mm is not None:
            self._push(aside_mm)
        if self._driven:
            self._free_wheels()
        self._left_dps, self._right_dps = left_deg * self._hz, right_deg * self._hz
        flags = (left.mode and FLAG_LEFT_RUNNING) | (right.mode and FLAG_RIGHT_RUNNING)
        flags |= (self.pen_down and FLAG_PEN_DOWN) | self.press_flags
        TICK_RECORD.pack_into(
            buffer,
            64 + 64 * count,
            tick,
            self.line,
            drive.x_mm,
            drive.y_mm,
            drive.heading_deg,
            left.position_deg,
            right.position_deg,
            self._left_dps,
            self._right_dps,
            drive.gyro_zero_deg,
            flags,
            self.actions & 0xFFFF,
        )
        self._publish(1)

    def _push(self, aside_mm: tuple[float, float]) -> None:
        """Move the robot aside by a distance in mm along x and along y."""
        drive = self.drive
        drive.x_mm, drive.y_mm = drive.x_mm + aside_mm[0], drive.y_mm + aside_mm[1]

    def _clear_ticks(self, most: int) -> int:
        """Return for how many ticks, at most `most`, no collision is possible unless a command changes the motion."""
        left, right = self.left, self.right
        if self._solids is None or (self._driven and left.resting and right.resting):
            return most
        if left.blocked_ticks or right.blocked_ticks:
            return 0
        left_ends, right_ends = self._list_wheel_speeds(left, right)
        per_dps = self._tick_s * abs(self._left_mm_per_deg)
        straight = 0
        turn = 0.0
        if left_ends == right_ends and left_ends[0] * left_ends[1] >= 0:
            straight = 1 if sum(left_ends) > 0 else -1
        else:
            turn = (
                max(max(right_ends) - min(left_ends), max(left_ends) - min(right_ends))
                * per_dps
                / self._spacing_mm
            )
        fastest = max(map(abs, (*left_ends, *right_ends))) * per_dps
        way = fastest + turn * self._solids.reach_mm
        if way == 0.0:
            return most
        pose = self._pose()
        free = self._solids.find_free_way_mm(pose, way * min(most, CHECK_TICKS), straight)
        # Without any obstacle, `free` is infinite, which `int` refuses.
        return most if free >= way * most else int(free / way)

    def _list_wheel_speeds(
        self, left: Motor, right: Motor
    ) -> tuple[tuple[float, float], tuple[float, float]]:
        """Return the present and the target speed of the left and of the right wheel, in degrees per second.

        Speeds are positive forwards.
        """
        left_ends, right_ends = (left.moving_dps, left.aim_dps), (right.moving_dps, right.aim_dps)
        return (
            left_ends if self._left_mm_per_deg > 0 else (-left_ends[0], -left_ends[1]),
            right_ends if self._right_mm_per_deg > 0 else (-right_ends[0], -right_ends[1]),
        )

    def _pose(self) -> tuple[float, float, float]:
        drive = self.drive
        return drive.x_mm, drive.y_mm, drive.heading_deg

    def _undo_blocked(
        self, before: tuple[MotorState, MotorState], left_deg: float, right_deg: float
    ) -> tuple[float, tuple[float, float] | None]:
        """Undo the part of a tick that an obstacle or wall blocks.

        Args:
            before: The states of the left and the right wheel's motor before the tick.
            left_deg, right_deg: How far these motors have turned in the tick.

        Returns:
            The part of the tick that remains, 0 … 1, and the displacement in mm along x and y by which obstacles push
            the robot aside; None for no displacement.
        """
        left_mm, right_mm = left_deg * self._left_mm_per_deg, right_deg * self._right_mm_per_deg
        if self._solids is None or (left_mm == 0.0 and right_mm == 0.0):
            return 1.0, None
        turn_deg = degrees((right_mm - left_mm) / self._spacing_mm)
        pose = self._pose()
        part, aside_mm = self._solids.find_leeway(pose, (left_mm + right_mm) / 2, turn_deg)
        if part == 1.0:
            self.left.blocked_ticks = self.right.blocked_ticks = 0
            return part, aside_mm
        for motor, state, turned_deg in zip(
            (self.left, self.right), before, (left_deg, right_deg), strict=True
        ):
            motor.hold_back(state, turned_deg, part)
            if motor.blocked_ticks == self.stall_ticks and not self._driven:
                self.changed = True
        return part, aside_mm

    def _free_wheels(self) -> None:
        """Remove the block from both wheels' motors if no obstacle blocks the robot any more."""
        self._is_placed = False
        left, right = self._driven[0], self._driven[1]
        if not (left.is_barred or right.is_barred):
            return
        left_deg, right_deg = left.tendency_deg, right.tendency_deg
        left_mm, right_mm = left_deg * self._left_mm_per_deg, right_deg * self._right_mm_per_deg
        blocked = self._is_blocked(left_mm, right_mm)
        left.bar(left_deg if blocked else 0.0)
        right.bar(right_deg if blocked else 0.0)

    def _is_blocked(self, left_mm: float, right_mm: float) -> bool:
        """Return whether an obstacle blocks a motion of the wheels from its start; a very small motion does not count.

        Args:
            left_mm, right_mm: How far the left and the right wheel would roll.
        """
        if self._solids is None or (left_mm == 0.0 and right_mm == 0.0):
            return False
        turn_deg = degrees((right_mm - left_mm) / self._spacing_mm)
        part = self._solids.find_leeway(self._pose(), (left_mm + right_mm) / 2, turn_deg).part
        way_mm = part * max(abs(left_mm), abs(right_mm))
        return way_mm < STANDSTILL_DEG * abs(self._left_mm_per_deg)

    def _build_record(self) -> tuple[float, ...]:
        """Return the tick record of the current tick, with the fields of `TICK_RECORD`."""
        return (
            self.tick,
            self.line,
            *self._pose(),
            self.left.position_deg,
            self.right.position_deg,
            self._left_dps,
            self._right_dps,
            self.drive.gyro_zero_deg,
            self._build_flags(),
            self.actions & 0xFFFF,
        )

    def _build_flags(self) -> int:
        return (
            (FLAG_LEFT_RUNNING if self.left.mode else 0)
            | (FLAG_RIGHT_RUNNING if self.right.mode else 0)
            | (FLAG_PEN_DOWN if self.pen_down else 0)
            | self.press_flags
        )

    def _make_room(self, ticks: int) -> Buffer:
        """Return a buffer with space for at least `ticks` more records."""
        end = self._sink.count + ticks
        if end > self._room_end:
            self._buffer = self._sink.reserve(ticks + ROOM_TICKS)
            self._room_end = end + ROOM_TICKS
            self._motor_recorder.make_room(self._room_end)
        return self._buffer

    def _glide(self, ticks: int) -> None:
        """Advance the simulation by ticks in which only the motors' ramps and the robot's pose change."""
        while ticks:
            noise = self.noise.motor
            ramping = (
                ticks
                if noise
                else min(ticks, max(self.left.ramping_ticks, self.right.ramping_ticks))
            )
            part = ramping or ticks
            if part <= MAX_SINGLE_TICKS:
                for _ in range(part):
                    self.tick_once()
                ticks -= part
                continue
            # Reserve space before anything moves: if there is none, the ticks do not happen.
            buffer = self._make_room(part)
            sink = self._sink
            hz = self._hz
            offset = 64 + 64 * sink.count
            flags = self._build_flags()
            actions = self.actions & 0xFFFF
            offsets = range(offset, offset + 64 * part, 64)
            ticks_ahead = range(self.tick + 1, self.tick + 1 + part)
            records = Records(buffer, offsets, ticks_ahead, self.line, flags, actions, hz)
            if ramping:
                left, right = (
                    self._glide_with_noise(part)
                    if noise
                    else (self.left.glide(part), self.right.glide(part))
                )
                self.drive.glide(records, left, right)
                left_deg, right_deg = left.rolls_deg[-1], right.rolls_deg[-1]
            else:
                left_even, right_even = self.left.glide_evenly(part), self.right.glide_evenly(part)
                counts = self.drive.glide_evenly(records, left_even, right_even)
                self.left.position_deg, self.right.position_deg = counts
                left_deg, right_deg = left_even.roll_deg, right_even.roll_deg
            self._left_dps, self._right_dps = left_deg * hz, right_deg * hz
            self.tick += part
            self._publish(part)
            ticks -= part

    def _glide_with_noise(self, ticks: int) -> tuple[Glide, Glide]:
        """Advance both wheels' motors by ticks with noise, and return how each of them moves."""
        assert isinstance(self.left, BrickMotor) and isinstance(self.right, BrickMotor)
        left, right = draw_noises(self.spec.seed, self.tick + 1, ticks, self.noise.motor)
        return self.left.glide_noisily(ticks, left), self.right.glide_noisily(ticks, right)
