"""The simulation of one run: the current state of the world, and changes from outside."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from tuisim.engine.core.drift import can_strain_gyro, find_drift, sense_turn_rate_dps
from tuisim.engine.core.drive import round_to_float32, turn_rate_dps
from tuisim.engine.core.driver.jiffies import draw_jiffies
from tuisim.engine.core.driver.simulated import SimulatedMotor, change_load
from tuisim.engine.core.end_stops import build_stops
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.motion import Motion, create_motor
from tuisim.engine.core.motor_columns import MotorSink
from tuisim.engine.core.profile import NS_PER_S
from tuisim.engine.core.servo.motor import ServoMotor
from tuisim.engine.core.spec import NO_PORT
from tuisim.engine.core.state import Instant, Present
from tuisim.engine.core.tick_record import (
    END_FLAGS,
    FLAGS_OFFSET,
    RUNNING_FLAGS,
    TICK_RECORD,
    TickSink,
)

if TYPE_CHECKING:
    from tuisim.engine.core.commands.calls import Call
    from tuisim.engine.core.motors import Motor
    from tuisim.engine.core.servo.drive_base import DriveBase
    from tuisim.engine.core.spec import MotorSpec, RobotSpec, RunSpec


CommandHook = Callable[[int, int, "Call", tuple[float, ...]], None]
"""Takes the time in ns, the number of the part, the call and its values, as in `SimulationCommand`."""
Turn = tuple[float, float]
"""Position in degrees and speed in degrees per second, both at the axle."""


class Simulation(Motion):
    """The simulation of one run: robot, motors and world, as programs and users read and change them."""

    __slots__ = (
        "_reported",
        "_reported_tick",
        "_stops",
        "bases",
        "on_command",
        "on_turns",
        "others",
        "scales",
    )

    def __init__(self, spec: RunSpec, sink: TickSink) -> None:
        extra = spec.robot.extra_motors
        self.others: tuple[Motor, ...] = tuple(
            create_motor(spec, motor.kind, free=True) for motor in extra
        )
        """Motors that do not drive a wheel, in the order of `RobotSpec.extra_motors`."""
        self._stops = tuple(
            build_stops(spec.robot, *pair) for pair in zip(extra, self.others, strict=True)
        )
        super().__init__(spec, sink, self.others)
        self.on_turns: Callable[[tuple[Turn, ...]], None] = lambda _: None
        """Called with the turns of `others` when one of these motors deviates from its last report; until then it turns
        as reported."""
        self._reported: tuple[Turn, ...] = ((0.0, 0.0),) * len(self.others)
        self._reported_tick = 0
        self.scales: dict[Motor, float] = {}
        """How many degrees the program counts for one degree of a motor; 1 for a motor without an entry."""
        self.bases: dict[int, DriveBase] = {}
        """The newest drive bases that the program has made, by number; the last one made comes last."""
        self.on_command: CommandHook = lambda *_: None
        """Called with each command before it takes effect."""

    @property
    def motors_by_port(self) -> dict[str, Motor]:
        """The motors that are on a port, by the name of the port."""
        pairs = zip(self.spec.robot.motors, self.motors, strict=True)
        return {spec.port: motor for spec, motor in pairs if spec.port != NO_PORT}

    # Reading

    def count_ticks(self, time_ns: int) -> int:
        """Return the number of ticks that are due at a time in ns from the start."""
        return time_ns * self._hz // NS_PER_S

    @property
    def pose(self) -> Pose:
        """The robot's pose."""
        drive = self.drive
        return Pose(drive.x_mm, drive.y_mm, drive.heading_deg)

    def build_instant(self, *, with_motors: bool = False) -> Instant:
        """Return the current instant, with values rounded as the telemetry stores them.

        Args:
            with_motors: Whether to include the values of the motors' drivers, and how many degrees the program counts
                for one degree of each motor.
        """
        left = round_to_float32(self._left_dps)
        right = round_to_float32(self._right_dps)
        spec = self.spec
        return Instant(
            tick=self.tick,
            pose=self.pose,
            left_position_deg=self.left.position_deg,
            right_position_deg=self.right.position_deg,
            left_speed_dps=left,
            right_speed_dps=right,
            turn_rate_dps=turn_rate_dps(left, right, spec.robot)
            if self._slipping is None
            else sense_turn_rate_dps(left, right, spec),
            gyro_zero_deg=self.drive.gyro_zero_deg,
            press_flags=self.press_flags,
            noise=self.noise,
            drift=find_drift(spec),
            profile=spec.profile,
            seed=spec.seed,
            motors=self.motor_values if with_motors else (),
            scales=self._list_scales() if with_motors else (),
        )

    def _list_scales(self) -> tuple[float, ...]:
        """Return for each motor how many degrees the program counts while the motor turns by one degree."""
        return tuple(self.scales.get(motor, 1.0) for motor in self.motors)

    def read_present(self, now_ns: int) -> Present:
        """Return what the program would read at a time after the last tick; it may advance the drivers to that time."""
        return Present(
            turns=tuple(motor.read_turn(now_ns) for motor in self.motors),
            motors=self._motor_recorder.read_values(None),
            scales=self._list_scales(),
            gyro_zero_deg=self.drive.gyro_zero_deg,
            pen_down=self.pen_down,
            actions=self.actions & 0xFFFF,
        )

    def read_records(self, first: int) -> Iterator[tuple[float, ...]]:
        """Return the tick records from `first` on, with the fields of `TICK_RECORD`."""
        return TICK_RECORD.iter_unpack(self._buffer[64 + 64 * first : 64 + 64 * self._sink.count])

    # Changing

    def find_number(self, motor: Motor) -> int:
        """Return the index of a motor among all motors, which identifies it in commands."""
        return self.motors.index(motor)

    def press(self, hand_flags: int) -> None:
        """Set which touch sensors are pressed by hand, as flags from `find_hand_flags`; all others are released."""
        self.press_flags = self.press_flags & END_FLAGS | hand_flags

    def restart(self, spec: RunSpec, sink: TickSink, motor_sink: MotorSink | None = None) -> None:
        """Begin a recorded run with a simulation that was prepared without a recording, and has not run yet.

        Args:
            spec: The run; it may differ from the prepared one in seed, noise and start only.
            sink: Receives the tick records.
            motor_sink: Receives the values of the motors' drivers; None without drivers, or if they are not recorded.
        """
        self._begin(spec, sink, motor_sink)

    def place(self, pose: Pose) -> None:
        """Set the robot's pose; the gyro keeps its angle."""
        drive = self.drive
        before_deg = self.drive.heading_deg
        drive.put(pose)
        drive.gyro_zero_deg = round_to_float32(drive.gyro_zero_deg + drive.heading_deg - before_deg)
        self._is_placed = self.notices

    def reset_gyro(self, shown_deg: float = 0.0) -> None:
        """Make the gyro show the angle `shown_deg`, clockwise, at the current heading."""
        self.drive.gyro_zero_deg = round_to_float32(self.drive.heading_deg + shown_deg)

    @property
    def gyro_deg(self) -> float:
        """The angle that the gyro shows, clockwise, not rounded."""
        return self.drive.gyro_zero_deg - self.drive.heading_deg

    def change_robot(self, robot: RobotSpec) -> None:
        """Continue the run with a robot that has other parts.

        A motor keeps its state if its port has the same kind of motor as before, even if it now drives a wheel or no
        longer does; every other motor is new, and at rest.
        """
        before = {
            find_place(number, motor): number for number, motor in enumerate(self.spec.robot.motors)
        }
        sources = [before.get(find_place(index, motor)) for index, motor in enumerate(robot.motors)]
        self.spec = replace(self.spec, robot=robot)
        earlier = self.motors
        motors = [
            self._add_motor(motor.kind, free=number > 1)
            if source is None
            else self._keep_motor(earlier[source], motor.kind, source, number)
            for number, (motor, source) in enumerate(zip(robot.motors, sources, strict=True))
        ]
        self.left, self.right, *others = motors
        self.others, self.motors = tuple(others), tuple(motors)
        self._take_others(sources[2:])
        self._driven = tuple(motor for motor in motors if isinstance(motor, SimulatedMotor))
        self._motor_recorder.change_motors(self._driven, sources, self._sink.count)
        self._motor_recorder.make_room(self._room_end)
        self._build_solids(self.spec)
        self._strains_gyro = can_strain_gyro(self.spec)
        if others:
            # Now that the robot has other motors than those of wheels, every tick must run these, too.
            self.__class__ = FurtherMotors

    def _take_others(self, sources: Sequence[int | None]) -> None:
        """After a change of the robot, update the end stops and the last reported turns of motors that drive no wheel.

        Args:
            sources: For each such motor its number among all motors before the change; None for a new motor.
        """
        stops = self._stops
        reported = self._reported
        robot = self.spec.robot
        pairs = [*zip(robot.extra_motors, self.others, sources, strict=True)]
        self._stops = tuple(
            stops[number] if source == number + 2 else build_stops(robot, motor, simulated)
            for number, (motor, simulated, source) in enumerate(pairs)
        )
        self._reported = tuple(
            (0.0, 0.0) if source is None or source < 2 else reported[source - 2]
            for source in sources
        )

    def _add_motor(self, kind: str, *, free: bool) -> Motor:
        """Return a new motor that is at rest at the present tick.

        Args:
            kind: The kind of motor.
            free: Whether it drives no wheel.
        """
        motor = create_motor(self.spec, kind, free=free)
        if isinstance(motor, SimulatedMotor):
            motor.start_clock(draw_jiffies(self.spec.seed))
        motor.glide_evenly(self.tick)
        return motor

    def _keep_motor(self, motor: Motor, kind: str, before: int, after: int) -> Motor:
        """Return a motor that stays when the robot changes; if it gains or loses a wheel, change its load.

        Args:
            motor: The motor.
            kind: The kind of the motor, one of `MOTOR_KINDS`.
            before, after: The number of the motor before and after the change; the motors with the numbers 0 and 1
                drive the wheels.
        """
        free = after > 1
        if free != (before > 1) and isinstance(motor, SimulatedMotor | ServoMotor):
            change_load(motor.axle, self.spec, kind, free=free)
        return motor

    @property
    def has_driven(self) -> bool:
        """Whether a wheel has turned since the start of the run, or its motor has been started."""
        is_moving = self.left.mode or self.right.mode
        return bool(is_moving) or any(record[7] or record[8] for record in self.read_records(0))

    def has_turned(self, number: int) -> bool:
        """Return whether a motor that drives no wheel has turned or is about to; `number` counts only such motors."""
        motor = self.others[number]
        return bool(motor.mode or motor.position_deg) or self._reported[number] != (0.0, 0.0)

    def update_record(self) -> None:
        """Write the current tick's record again, after a user has changed something.

        Whether a motor is running stays as it was at the tick: since then, its driver may have advanced.
        """
        offset = 64 * self._sink.count
        running = self._buffer[offset + FLAGS_OFFSET] & RUNNING_FLAGS
        *values, flags, actions = self._build_record()
        flags = int(flags) & ~RUNNING_FLAGS | running
        # One call writes the whole record: readers already see it, and must not see half of a change.
        self._buffer[offset : offset + 64] = TICK_RECORD.pack(*values, flags, actions)


REPORT_DEG = 0.25
"""A motor farther than this from the position that its last report predicts is reported again."""


def find_place(number: int, motor: MotorSpec) -> tuple[str | int, str]:
    """Return the port and the kind of a motor, by which it is found again when the robot changes.

    A motor without a port has its number in place of the port.
    """
    return number if motor.port == NO_PORT else motor.port, motor.kind


class FurtherMotors(Simulation):
    """A simulation whose robot has motors besides its two wheel motors. They do not change the pose."""

    __slots__ = ()

    def advance(self, ticks: int, until_change: bool = False) -> int:
        """Advance the simulation, and return how many ticks have been run.

        While a motor that drives no wheel runs, the ticks are run one by one.

        Args:
            ticks: Number of ticks.
            until_change: Whether to return earlier, as soon as a motor has ended a move.
        """
        done = 0
        self._report_turns()
        while done < ticks and not all(motor.resting for motor in self.others):
            if until_change and self._driven and self.notice_change():
                return done
            self.tick_once()
            done += 1
            if until_change and self.changed:
                return done
        return done + super().advance(ticks - done, until_change) if done < ticks else done

    def notice_change(self) -> bool:
        """Report how the motors that drive no wheel turn, then run the drivers' checks as in `Motion.notice_change`.

        A report is a call of `on_turns` with the position and the speed of each such motor. There is no report while
        they all move on at the speeds of the last report.

        Returns:
            Whether a driver notices that a motor has changed.
        """
        self._report_turns()
        return super().notice_change()

    def tick_once(self) -> None:
        """Run one tick of the motors that drive no wheel, then of the robot, and record it."""
        # A position may have been set, or a motor started, since the last tick.
        self._report_turns()
        # Reserve space before anything moves: if there is none, the tick does not happen.
        self._make_room(1)
        for motor, stops in zip(self.others, self._stops, strict=True):
            if not motor.resting:
                before = motor.mode
                stops.step(motor, self.tick + 1)
                if not self._driven and (
                    motor.mode != before or motor.blocked_ticks == self.stall_ticks
                ):
                    self.changed = True
        flags = sum(stops.flags for stops in self._stops)
        self.press_flags = self.press_flags & ~END_FLAGS | flags
        super().tick_once()
        self._report_turns()

    def _report_turns(self) -> None:
        turns = tuple((motor.position_deg, motor.counting_dps) for motor in self.others)
        since_s = (self.tick - self._reported_tick) * self._tick_s
        if any(
            dps != before_dps or abs(position - before - before_dps * since_s) > REPORT_DEG
            for (position, dps), (before, before_dps) in zip(turns, self._reported, strict=True)
        ):
            self._reported, self._reported_tick = turns, self.tick
            self.on_turns(turns)


def build_simulation(spec: RunSpec, sink: TickSink) -> Simulation:
    """Return the simulation of a run; a `FurtherMotors` if the robot has motors besides its wheel motors.

    `sink` receives the tick records.
    """
    return FurtherMotors(spec, sink) if spec.robot.extra_motors else Simulation(spec, sink)
