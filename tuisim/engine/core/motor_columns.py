"""The values of each motor's driver at the end of a tick: their record, and their columns.

Only motors with a driver have them: see `Motion.motor_values`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from struct import Struct
from typing import TYPE_CHECKING, Protocol

from tuisim.engine.core.columns import Column
from tuisim.engine.core.profile import MotorLaw

if TYPE_CHECKING:
    from tuisim.engine.core.field import Field
    from tuisim.engine.core.spec import RobotSpec, RunSpec
    from tuisim.engine.core.state import Instant, MotorValues
    from tuisim.engine.core.tick_record import Buffer

MOTOR_FIELDS = (
    ("asked_dps", "<i4"),
    ("measured_dps", "<i2"),
    ("duty_pc", "i1"),
    ("state", "u1"),
)
"""Name and type of each recorded value of a motor; types are written as numpy does."""
MOTOR_RECORD = Struct("<ihbB")


class MotorSink(Protocol):
    """A receiver of the `MOTOR_RECORD`s of all motors at each tick.

    It does not store how many ticks are complete: readers take that number from the telemetry.
    """

    def extend_buffer(self, ticks: int) -> Buffer:
        """Return a writable buffer with space for the records of `ticks` ticks; the first record begins at byte 64."""

    def arrange(self, sources: Sequence[int | None], ticks: int) -> None:
        """Rewrite the records of all past ticks for another set of motors.

        Args:
            sources: For each new motor the number that it had before; None for one that has been at rest.
            ticks: How many ticks are recorded.
        """


RUNNING, RAMPING, HOLDING, STALLED, OVERLOADED = (1 << bit for bit in range(5))
"""The bits of `state`."""
STATE_BITS: Mapping[str, int] = {
    "running": RUNNING,
    "ramping": RAMPING,
    "holding": HOLDING,
    "stalled": STALLED,
    "overloaded": OVERLOADED,
}


class DrivenMotor(Protocol):
    """A motor with a driver that can write its `MOTOR_RECORD`."""

    def record(self, buffer: Buffer, at: int) -> None: ...


class MotorRecorder:
    """A writer of the records of all motors of a run.

    Args:
        motors: The motors with a driver, in the order of `name_motors`.
        sink: Receives the records; None if nobody does.
    """

    def __init__(self, motors: tuple[DrivenMotor, ...], sink: MotorSink | None) -> None:
        self._motors = motors
        self._sink = sink
        self._size = MOTOR_RECORD.size * len(motors)
        """Bytes of all motors' records of one tick."""
        self._buffer: Buffer | None = None

    def change_motors(
        self, motors: tuple[DrivenMotor, ...], sources: Sequence[int | None], ticks: int
    ) -> None:
        """Write the records of another set of motors from now on, and rewrite those of past ticks for it.

        Args:
            motors: The motors.
            sources: For each of them the number that it had before; None for one that has been at rest.
            ticks: How many ticks are recorded.
        """
        self._motors, self._size = motors, MOTOR_RECORD.size * len(motors)
        if self._sink is not None:
            self._sink.arrange(sources, ticks)

    def make_room(self, ticks: int) -> None:
        """Make the sink's buffer large enough for the records of `ticks` ticks in all."""
        if self._sink is not None:
            self._buffer = self._sink.extend_buffer(ticks)

    def record(self, tick: int, ticks: int) -> None:
        """Record the drivers' present values for `ticks` ticks from `tick` on, the same for all of them."""
        buffer = self._buffer
        if buffer is None:
            return
        begin = offset = 64 + self._size * tick
        for motor in self._motors:
            motor.record(buffer, offset)
            offset += MOTOR_RECORD.size
        if ticks > 1:
            buffer[offset : begin + self._size * ticks] = buffer[begin:offset] * (ticks - 1)

    def read_values(self, tick: int | None) -> tuple[MotorValues, ...]:
        """Return the values of all motors' drivers that were recorded at a tick.

        If `tick` is None, or nothing is recorded, return the drivers' present values.
        """
        buffer = self._buffer
        begin = 0 if tick is None else self._size * tick + 64
        if buffer is None or tick is None:
            buffer = bytearray(self._size)
            begin = 0
            for number, motor in enumerate(self._motors):
                motor.record(buffer, MOTOR_RECORD.size * number)
        return tuple(MOTOR_RECORD.iter_unpack(buffer[begin : begin + self._size]))


def has_driver(run: RunSpec) -> bool:
    """Return whether the motors of a run have a driver, whose values are recorded in addition to the telemetry."""
    return run.profile.motor_law is MotorLaw.EV3DEV


def name_motors(robot: RobotSpec) -> tuple[str, ...]:
    """Return the prefix of each motor's columns: `left` and `right` for the wheels, such as `motor_a` for others."""
    return "left", "right", *(f"motor_{motor.port[-1].lower()}" for motor in robot.extra_motors)


def build_motor_columns(name: str) -> tuple[Column, ...]:
    """Return the columns of a motor: the measured ones, then a column for each state.

    The column of a state is 1 while the motor is in this state, else 0; it is NaN where nothing is recorded.
    """
    measured = (Column(f"{name}_{field}", is_traced=field != "state") for field, _ in MOTOR_FIELDS)
    states = (
        Column(f"{name}_{state}", partial(_apply_bit, bit)) for state, bit in STATE_BITS.items()
    )
    return *measured, *states


def _apply_bit(bit: int, rows: Iterable[Sequence[float]], _: RunSpec) -> list[float]:
    # Where nothing is recorded, the state is NaN, and so is the result.
    return [float(int(row[3]) & bit != 0) if row[3] >= 0 else row[3] for row in rows]


def measure_motor(number: int, instant: Instant, _: RunSpec, __: Field) -> tuple[float, ...]:
    """Return the values of a motor's measured columns; `number` is its number among all motors."""
    asked_dps, measured_dps, duty_pc, state = instant.motors[number]
    scale = instant.get_scale(number)
    return asked_dps * scale, measured_dps * scale, duty_pc * scale, float(state)


def find_motor_owners(
    run: RunSpec,
) -> list[tuple[tuple[Column, ...], Callable[[Instant, RunSpec, Field], tuple[float, ...]]]]:
    """Return for each motor its columns and the function that measures them; an empty list if motors have no driver."""
    if not has_driver(run):
        return []
    return [
        (build_motor_columns(name), partial(measure_motor, number))
        for number, name in enumerate(name_motors(run.robot))
    ]
