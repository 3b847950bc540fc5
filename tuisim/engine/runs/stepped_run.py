"""A run that a script advances step by step, without a program."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from math import nan
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tuisim.base.errors import ConfigError
from tuisim.base.source import Program
from tuisim.engine.core.commands.calls import Call, SimulationCommand
from tuisim.engine.core.commands.table import obey
from tuisim.engine.core.motors import find_top_speed_dps
from tuisim.engine.core.pen_marks import PenMarks
from tuisim.engine.core.profile import DRIVEN_LAWS, NS_PER_S, MotorLaw
from tuisim.engine.core.servo.control import Ending
from tuisim.engine.core.servo.motor import ServoMotor
from tuisim.engine.core.simulation import Simulation, build_simulation
from tuisim.engine.core.tick_record import TICK_FIELDS, TICK_RECORD, MemoryRecording, NoRecording
from tuisim.engine.protocol import End, Ended
from tuisim.engine.runs.replay import give_command

if TYPE_CHECKING:
    import numpy as np

    from tuisim.engine.core.field import Field
    from tuisim.engine.core.geometry import Pose
    from tuisim.engine.core.spec import RunSpec
    from tuisim.engine.core.state import Instant
    from tuisim.engine.runs.records import OutputRow


class SteppedRun:
    """A run that a script advances step by step, without a program.

    Goals can evaluate it at any time, as if it ended then.

    Args:
        spec: The run.
        mat: Its mat.
        is_recorded: Whether its ticks are recorded; only then can `array` return them.
    """

    program = Program("script", "")
    answers = ()
    folder = Path("/nonexistent")
    """A folder that does not exist: nothing but the ticks is recorded."""

    def __init__(self, spec: RunSpec, mat: Field, *, is_recorded: bool) -> None:
        self.spec = spec
        self.telemetry = self.output = self
        self._mat = mat
        self._recording = MemoryRecording()
        has_marks = spec.world.pen_marks
        sink = self._recording if is_recorded or has_marks else NoRecording()
        self._sim = build_simulation(spec, sink)
        self._marks = PenMarks(mat, spec) if has_marks else None
        self._run = _find_run(self._sim)
        self.drive = self._sim.drive
        """The motion of the robot, which changes with each tick."""

    @property
    def tick(self) -> int:
        """The number of ticks that have passed."""
        return self._sim.tick

    @property
    def time_s(self) -> float:
        """The simulated time in seconds."""
        return self._sim.compute_due_ns(self._sim.tick) / NS_PER_S

    @property
    def pose(self) -> Pose:
        """The robot's present pose."""
        return self._sim.pose

    @property
    def max_speed_dps(self) -> float:
        """The highest speed of the wheels' motors, in degrees per second."""
        return find_top_speed_dps(self.spec.robot.left_motor, self.spec.profile)

    def read(
        self, readers: Mapping[str, Callable[[Instant, RunSpec, Field], float]]
    ) -> dict[str, float]:
        """Return the present values of columns, by name.

        Sensors see what the pen has drawn so far.

        Args:
            readers: Functions that return the value of a column at an instant, as from `build_reader`, by name.
        """
        mat = self._mat
        if self._marks is not None:
            self._marks.add_records(self._sim.read_records(self._marks.records))
            mat = self._marks.field
        instant = self._sim.build_instant()
        return {name: read(instant, self.spec, mat) for name, read in readers.items()}

    def turn_wheels(self, left_dps: float, right_dps: float) -> None:
        """Set the speeds at which the wheels' motors run from now on, in degrees per second."""
        time_ns = self._sim.compute_due_ns(self._sim.tick)
        self._run(time_ns, 0, left_dps)
        self._run(time_ns, 1, right_dps)

    def order(self, ticks: int, commands: Iterable[SimulationCommand]) -> list[SimulationCommand]:
        """Return commands in the order of their times, after checking that they lie within the next `ticks` ticks.

        They can then be passed to `advance` with the same number of ticks. The last of these ticks is allowed, too.

        Raises:
            ConfigError: a command lies before the present tick, or after the last one.
        """
        sim = self._sim
        end = sim.tick + ticks
        ordered = sorted(commands, key=lambda command: command.time_ns)
        for command in ordered[-1:] + ordered[:1]:
            if not sim.tick <= sim.count_ticks(command.time_ns) <= end:
                times_ns = command.time_ns, sim.compute_due_ns(sim.tick), sim.compute_due_ns(end)
                time_s, start_s, end_s = (f"{round(ns / NS_PER_S, 3):g}" for ns in times_ns)
                raise ConfigError(
                    f"a command at {time_s} s lies outside the step from {start_s} to {end_s} s"
                )
        return ordered

    def advance(self, ticks: int, commands: Iterable[SimulationCommand]) -> None:
        """Advance the run by ticks, and give each command at its own time; `order` must have checked the commands."""
        sim = self._sim
        end = sim.tick + ticks
        for command in commands:
            sim.advance(sim.count_ticks(command.time_ns) - sim.tick)
            give_command(sim, command)
        sim.advance(end - sim.tick)

    @property
    def ended(self) -> Ended:
        """The end of a run, as if the run ended at the present time."""
        return Ended(End.FINISHED, self._sim.tick, self._sim.compute_due_ns(self._sim.tick))

    def array(self) -> np.ndarray[Any, Any]:
        """Return the records of all ticks as a structured array of `TICK_FIELDS`."""
        import numpy as np

        end = TICK_RECORD.size * (1 + self._recording.count)
        records = bytes(memoryview(self._recording.buffer)[TICK_RECORD.size : end])
        return np.frombuffer(records, np.dtype(list(TICK_FIELDS)))

    def rows(self) -> Iterator[OutputRow]:
        """Yield no rows of output: there is no program."""
        yield from ()


def _find_run(sim: Simulation) -> Callable[[int, int, float], None]:
    """Return a function that sets the speed of a wheel's motor.

    The function takes the time in ns, the number of the motor and the speed in °/s.
    """
    robot = sim.spec.robot
    law = sim.spec.profile.motor_law
    signs = -1.0 if robot.left_reversed else 1.0, -1.0 if robot.right_reversed else 1.0
    most = [find_top_speed_dps(motor.kind, sim.spec.profile) for motor in robot.motors]

    def clip(number: int, speed_dps: float) -> float:
        return signs[number] * max(-most[number], min(most[number], speed_dps))

    def run(time_ns: int, number: int, speed_dps: float) -> None:
        obey(sim, time_ns, number, Call.RUN, clip(number, speed_dps))

    def run_driver(time_ns: int, number: int, speed_dps: float) -> None:
        values = float(round(clip(number, speed_dps))), 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        obey(sim, time_ns, number, Call.RUN_FOREVER, *values)

    def run_servo(time_ns: int, number: int, speed_dps: float) -> None:
        motor = sim.motors[number]
        assert isinstance(motor, ServoMotor)
        settings = motor.control.settings
        rate = float(settings.counts(round(clip(number, speed_dps))))
        values = rate, float(settings.acceleration), nan, float(Ending.HOLD)
        obey(sim, time_ns, number, Call.RUN_AT, *values)

    if law is MotorLaw.EV3DEV:
        return run_driver
    return run if law in DRIVEN_LAWS else run_servo
