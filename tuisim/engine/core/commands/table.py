"""What each kind of command does, which values it takes, and which motors have it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from enum import Enum, auto
from functools import partial
from typing import TYPE_CHECKING, Any

from tuisim.base.data_class import dataclass
from tuisim.engine.core.brick_motor import BrickMotor
from tuisim.engine.core.browser_motor import BrowserMotor
from tuisim.engine.core.commands import driver, robot, servo
from tuisim.engine.core.commands.calls import MAX_NUMBER, MAX_VALUES, Call, Values
from tuisim.engine.core.motors import MEDIUM_MAX_SPEED_DPS
from tuisim.engine.core.plugged import PART_CODES
from tuisim.engine.core.profile import DRIVEN_LAWS, MotorLaw
from tuisim.engine.core.servo.control import Ending
from tuisim.engine.core.servo.settings import FULL_ACTUATION

if TYPE_CHECKING:
    from tuisim.engine.core.servo.drive_base import DriveBase
    from tuisim.engine.core.simulation import Simulation

DrivenMotor = BrickMotor | BrowserMotor


def start(motor: DrivenMotor, _time_ns: int, values: Values) -> None:
    """Run a motor at a speed until the next command; the value is the speed in degrees per second."""
    motor.run(*values)


def start_timed(motor: DrivenMotor, _time_ns: int, values: Values) -> None:
    """Run a motor at a speed until a tick; `values` are the speed in degrees per second, and the tick."""
    motor.run_until(*values)


def start_move(motor: DrivenMotor, _time_ns: int, values: Values) -> None:
    """Run a motor to a position.

    Args:
        motor: The motor.
        values: The position in degrees, the speed in degrees per second, and 1 to turn backwards or 0 to turn forwards.
    """
    goal_deg, speed_dps, backwards = values
    motor.run_to(goal_deg, speed_dps, bool(backwards))


def stop(motor: DrivenMotor, _time_ns: int, _values: Values) -> None:
    """Stop a motor."""
    motor.stop()


def set_count(motor: DrivenMotor, _time_ns: int, values: Values) -> None:
    """Set the value that the encoder reports for its present position, in degrees, without moving the motor."""
    motor.position_deg = values[0]


def limit_ramps(motor: BrickMotor, _time_ns: int, values: Values) -> None:
    """Limit the acceleration and the deceleration of the motor's current move.

    `values` are these two numbers, in degrees per second squared.
    """
    motor.slowest_ramp_dps2, motor.approach_dps2 = values


def set_speed(motor: BrowserMotor, _time_ns: int, values: Values) -> None:
    """Set the speed that the motor's speed register approaches, in degrees per second."""
    motor.speed_sp = values[0]


def set_backwards(motor: BrowserMotor, _time_ns: int, values: Values) -> None:
    """Set whether moves to a position turn backwards (1) or not (0).

    This also changes the present move, even one that has reached its position.
    """
    motor.backwards = bool(values[0])


def set_roll(motor: BrowserMotor, _time_ns: int, values: Values) -> None:
    """Set whether the wheel rolls in the direction in which the encoder counts (1) or in the opposite one (-1).

    Raises:
        ValueError: the value is not 1 or -1.
    """
    if abs(values[0]) != 1.0:
        raise ValueError(f"{values[0]!r} is not a direction")
    motor.roll_sign = values[0]


def set_polarity(_motor: Any, _time_ns: int, _values: Values) -> None:
    """Do nothing: this command does not change the simulated motor.

    It is recorded because it tells with which sign the program counts degrees from now on. The value is 0 for the sign
    of the motor, and 1 for the opposite sign.
    """


SCALING_CALLS = (Call.SET_UP, Call.SET_POLARITY)
"""These change how many degrees the program counts for one of a motor."""


def compute_scale(call: int, values: Sequence[float]) -> float:
    """Return how many degrees a program counts while a motor turns by one degree, such as -1 for a reversed motor.

    Args:
        call: The command that set this number, one of `SCALING_CALLS`.
        values: The values of the command.

    Returns:
        The number; 0 if the command is damaged.
    """
    if call == Call.SET_POLARITY:
        return 1 - 2 * values[0]
    sign, gear_ratio, *_ = values
    return sign / gear_ratio if gear_ratio > 0 else 0.0


Range = tuple[float, float]

ALL_LAWS = frozenset(MotorLaw)
PYBRICKS_4 = frozenset({MotorLaw.PYBRICKS_4})
SERVO_LAWS = frozenset({MotorLaw.PYBRICKS, MotorLaw.PYBRICKS_4})
_ANY: Range = -MAX_NUMBER, MAX_NUMBER
_POSITIVE: Range = 0.0, MAX_NUMBER
_FLAG: Range = 0.0, 1.0
_ENDING: Range = 0.0, float(max(Ending))
_SPEED: Range = -MEDIUM_MAX_SPEED_DPS, MEDIUM_MAX_SPEED_DPS
_DUTY: Range = -float(FULL_ACTUATION), float(FULL_ACTUATION)
_INT: Range = -float(2**31), float(2**31)
_RAMP_MS: Range = 0.0, 60_000.0
_SET_POINTS = (_SPEED, _INT, (-100.0, 100.0), _INT, _RAMP_MS, _RAMP_MS, (0.0, 2.0))


class Target(Enum):
    """The kind of thing on which a command acts: the robot, a motor or a drive base."""

    ROBOT = auto()
    MOTOR = auto()
    BASE = auto()
    """A drive base that the program has made."""


@dataclass(frozen=True, slots=True)
class CallSpec:
    """The description of a command: the function that executes it, its allowed values and its allowed motors."""

    apply: Callable[[Any, int, Values], None]
    """Executes the command; takes the part that it is for, the time in ns and the values."""
    ranges: tuple[Range, ...] = ()
    """The lowest and the highest allowed number for each value."""
    laws: frozenset[MotorLaw] = ALL_LAWS
    may_be_missing: bool = False
    """Whether values may be NaN."""
    target: Target = Target.MOTOR
    speed_place: int | None = None
    """Index of the value that is a speed, limited by the kind of motor; None without one."""


def _specify_servo(
    apply: Callable[[Any, int, Values], None],
    *ranges: Range,
    laws: frozenset[MotorLaw] = SERVO_LAWS,
    **more: Any,
) -> CallSpec:
    """Return the description of a command that only motors of the Pybricks firmware have.

    Args:
        apply: Executes the command; takes the motor or drive base, the time in ns and the values.
        ranges: The allowed range of each value.
        laws: The motor laws under which the command is allowed.
        more: Other fields of `CallSpec`.
    """
    return CallSpec(apply, ranges, laws, **more)


_specify_base = partial(_specify_servo, target=Target.BASE)


CALLS: Mapping[Call, CallSpec] = {
    Call.RESET_GYRO: CallSpec(robot.reset_gyro, target=Target.ROBOT),
    Call.SET_GYRO: CallSpec(robot.set_gyro, (_ANY,), PYBRICKS_4, target=Target.ROBOT),
    Call.MOVE_PEN: CallSpec(robot.move_pen, (_FLAG,), target=Target.ROBOT),
    Call.PLUG: CallSpec(
        robot.plug_in,
        ((0.0, float(max(PART_CODES.values()))),) * MAX_VALUES,
        may_be_missing=True,
        target=Target.ROBOT,
    ),
    Call.RUN: CallSpec(start, (_ANY,), DRIVEN_LAWS, speed_place=0),
    Call.RUN_UNTIL: CallSpec(start_timed, (_ANY, _ANY), DRIVEN_LAWS, speed_place=0),
    Call.RUN_TO: CallSpec(start_move, (_ANY, _ANY, _FLAG), DRIVEN_LAWS, speed_place=1),
    Call.STOP: CallSpec(stop, (), DRIVEN_LAWS),
    Call.SET_COUNT: CallSpec(set_count, (_ANY,), DRIVEN_LAWS),
    Call.LIMIT_RAMPS: CallSpec(limit_ramps, (_POSITIVE, _POSITIVE), frozenset({MotorLaw.BRICK})),
    Call.SET_SPEED: CallSpec(set_speed, (_ANY,), frozenset({MotorLaw.NBEV3DEVSIM})),
    Call.SET_BACKWARDS: CallSpec(set_backwards, (_FLAG,), frozenset({MotorLaw.NBEV3DEVSIM})),
    Call.SET_ROLL: CallSpec(set_roll, ((-1.0, 1.0),), frozenset({MotorLaw.NBEV3DEVSIM})),
    Call.SET_POLARITY: CallSpec(
        set_polarity, (_FLAG,), frozenset({MotorLaw.BRICK, MotorLaw.EV3DEV})
    ),
    **{
        call: CallSpec(
            driver.build_effect(command), _SET_POINTS, frozenset({MotorLaw.EV3DEV}), speed_place=0
        )
        for command, call in driver.COMMAND_CALLS.items()
    },
    Call.SET_DUTY: CallSpec(driver.set_duty, ((-100.0, 100.0),), frozenset({MotorLaw.EV3DEV})),
    Call.RENUMBER: CallSpec(driver.set_position, (_ANY,), frozenset({MotorLaw.EV3DEV})),
    Call.SET_CONSTANT: CallSpec(
        driver.set_constant, (_FLAG, (0.0, 2.0), _INT), frozenset({MotorLaw.EV3DEV})
    ),
    Call.SET_UP: _specify_servo(servo.begin_anew, (-1.0, 1.0), _POSITIVE, _FLAG),
    Call.RUN_FREELY: _specify_servo(servo.run_freely, _DUTY, may_be_missing=True),
    Call.SET_MILLI: _specify_servo(servo.set_milli, _ANY),
    Call.HOLD: _specify_servo(servo.hold),
    Call.HOLD_MILLI: _specify_servo(servo.hold_milli, _ANY),
    Call.RUN_AT: _specify_servo(
        servo.run_control, _ANY, _ANY, _POSITIVE, _ENDING, may_be_missing=True
    ),
    Call.MOVE: _specify_servo(servo.move, _ANY, _ANY, _ANY, _FLAG),
    Call.FOLLOW: _specify_servo(servo.follow, _ENDING),
    Call.LIMIT_DUTY: _specify_servo(servo.limit_duty, _DUTY, may_be_missing=True),
    Call.SET_CONTROL: _specify_servo(servo.set_control, _POSITIVE, _POSITIVE),
    Call.BUILD_BASE: _specify_servo(servo.build_base, *(_POSITIVE,) * 4, target=Target.ROBOT),
    Call.MOVE_BASE: _specify_base(servo.move_base, _ANY, _ANY, _ENDING),
    Call.DRIVE_BASE: _specify_base(servo.drive_base, _ANY, _ANY),
    Call.STOP_BASE: _specify_base(servo.stop_base, _DUTY, may_be_missing=True),
    Call.SET_BASE: _specify_base(servo.set_base, _ANY, _ANY, _ANY, _ANY),
    Call.SET_BASE_CONTROL: _specify_base(servo.set_base_control, _FLAG, _POSITIVE, _POSITIVE),
    Call.SET_SLOWING: _specify_base(servo.set_slowing, _POSITIVE, _POSITIVE, laws=PYBRICKS_4),
    Call.USE_GYRO: _specify_base(servo.use_gyro, _FLAG, laws=PYBRICKS_4),
}


def list_parts(sim: Simulation, target: Target) -> Sequence[Any] | Mapping[int, DriveBase]:
    """Return what commands for `target` act on: the motors, the drive bases, or only the simulation.

    The number of a part in a command is its index in the result.
    """
    if target is Target.MOTOR:
        return sim.motors
    return sim.bases if target is Target.BASE else (sim,)


def obey(sim: Simulation, time_ns: int, part: int, call: Call, *values: float) -> None:
    """Apply a command of a program to a simulation; the arguments are the fields of a `SimulationCommand`.

    Programs change a simulation only through this function, so that all their commands can be recorded.

    Raises:
        ValueError: a move is not possible.
        RobotError: the parts that are plugged in do not fit.
    """
    sim.on_command(time_ns, part, call, values)
    spec = CALLS[call]
    spec.apply(list_parts(sim, spec.target)[part], time_ns, values)
    if call in SCALING_CALLS:
        sim.scales[sim.motors[part]] = compute_scale(call, values)
