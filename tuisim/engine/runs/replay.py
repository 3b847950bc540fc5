"""Simulates a run again: its world, its user and the commands of its program give the same ticks, to the last bit.

No program can give a command with values that its motors do not allow, or a command with an earlier time than the one
before.
"""

from __future__ import annotations

import json
from collections import deque
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from math import inf
from time import thread_time
from typing import TYPE_CHECKING, Any

from tuisim.base.atomic import replacing
from tuisim.base.data_class import dataclass
from tuisim.base.errors import LogError
from tuisim.base.regular_file import read_regular
from tuisim.engine.core.commands.calls import Call, SimulationCommand
from tuisim.engine.core.commands.table import CALLS, Range, list_parts, obey
from tuisim.engine.core.driver.regulator import MODELS
from tuisim.engine.core.motor_columns import MOTOR_RECORD, has_driver, name_motors
from tuisim.engine.core.profile import NS_PER_S, MotorLaw, compute_due_ns
from tuisim.engine.core.simulation import Simulation, build_simulation
from tuisim.engine.core.tick_record import TICK_FIELDS, TICK_RECORD, MemoryRecording, NoRecording
from tuisim.engine.protocol import Stop, UserAction
from tuisim.engine.runs.command_records import read_commands
from tuisim.engine.runs.motor_records import MOTORS_MAGIC, arrange_records
from tuisim.engine.runs.records import (
    HEADER_BYTES,
    MOTORS_FILE,
    TELEMETRY_FILE,
    TELEMETRY_MAGIC,
    pack_header,
)
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.engine.runs.side_files import ACTIONS_FILE
from tuisim.engine.runs.user_changes import change_simulation
from tuisim.engine.runs.views import TelemetryView

if TYPE_CHECKING:
    from pathlib import Path

    import numpy as np

    from tuisim.engine.core.spec import RobotSpec, RunSpec

    Array = np.ndarray[Any, Any]

MAX_AN_INSTANT = 10_000
"""No program gives more commands at one time: what costs nothing costs something from the hundredth call on, and a
loop in which no time passes does, too."""


class CommandCheck:
    """A check of recorded commands, one after another, for commands that no program can have given.

    Args:
        sim: The simulation to which the commands will be given.
    """

    __slots__ = ("_count", "_newest_ns", "_ranges", "_robot", "_sim")

    def __init__(self, sim: Simulation) -> None:
        self._sim = sim
        self._robot = sim.spec.robot
        self._newest_ns = self._count = 0
        self._ranges: dict[tuple[Call, int], tuple[Range, ...]] = {}
        """The ranges of the values of calls to parts, as far as they are known of this robot."""

    def find_disorder(self, time_ns: int) -> str:
        """Return why the next command cannot have been given at a time, in words that follow "a command that".

        The text is empty if it can have been given then.
        """
        if time_ns < self._newest_ns:
            return "goes back in time"
        self._count = self._count + 1 if time_ns == self._newest_ns else 1
        self._newest_ns = time_ns
        return "the time is too short for" if self._count > MAX_AN_INSTANT else ""

    def find_fault(self, command: SimulationCommand) -> str:
        """Return why no program can have given a command, in words that follow "a command that"; empty if one can.

        Args:
            command: The command, right before it is given. Values that its call does not use are ignored.
        """
        _, part, call, values = command
        if self._sim.spec.robot is not self._robot:
            self._robot = self._sim.spec.robot
            self._ranges.clear()
        ranges = self._ranges.get((call, part))
        if ranges is None:
            if self._sim.spec.profile.motor_law not in CALLS[call].laws:
                return "no motor of this profile takes"
            if part >= len(list_parts(self._sim, CALLS[call].target)):
                return "is for a part that the robot does not have"
            ranges = self._ranges[call, part] = _narrow_ranges(call, part, self._sim)
        for value, (low, high) in zip(values, ranges, strict=False):
            if not low <= value <= high and (value == value or not CALLS[call].may_be_missing):
                return "has a value that is not allowed"
        return ""


def _narrow_ranges(call: Call, part: int, sim: Simulation) -> tuple[Range, ...]:
    """Return the allowed range of each value of a command; the range of a speed depends on the kind of motor.

    Args:
        call: The kind of command.
        part: The number of the motor that gets it.
        sim: The simulation.
    """
    ranges = [*CALLS[call].ranges]
    place = CALLS[call].speed_place
    if place is not None and sim.spec.profile.motor_law is not MotorLaw.NBEV3DEVSIM:
        max_dps = float(MODELS[sim.spec.robot.motors[part].kind].max_speed_dps)
        ranges[place] = -max_dps, max_dps
    return tuple(ranges)


_LOOK_EVERY = 1000
"""The time limit is checked once in this many commands."""


@dataclass(frozen=True, slots=True)
class ReplayedTicks:
    """The records that result when a run is simulated again from its commands and user actions."""

    telemetry: bytearray
    """A record for each tick, without a header; the lines of the program are 0."""
    motors: bytearray
    """The records of the motors for each tick; empty if they have no driver."""
    motor_bytes: int
    """Size in bytes of the motors' records of one tick."""
    robot: RobotSpec
    """The robot with all parts that were plugged in."""


class _Motors:
    """The records of motors in memory, used by `replay` in place of a `MotorsWriter`, which writes them to a file."""

    def __init__(self, robot: RobotSpec) -> None:
        self.tick_bytes = MOTOR_RECORD.size * len(name_motors(robot))
        self.buffer = bytearray(HEADER_BYTES)

    def extend_buffer(self, ticks: int) -> bytearray:
        need = HEADER_BYTES + ticks * self.tick_bytes
        if need > len(self.buffer):
            self.buffer += bytes(need)
        return self.buffer

    def arrange(self, sources: Sequence[int | None], ticks: int) -> None:
        end = HEADER_BYTES + ticks * self.tick_bytes
        count = self.tick_bytes // MOTOR_RECORD.size
        arranged = arrange_records(bytes(self.buffer[HEADER_BYTES:end]), count, sources, ticks)
        self.tick_bytes = MOTOR_RECORD.size * len(sources)
        self.buffer = bytearray(HEADER_BYTES) + arranged


def replay(
    spec: RunSpec,
    commands: Iterable[SimulationCommand],
    actions: Iterable[UserAction],
    last_tick: int,
    limit_s: float = inf,
) -> ReplayedTicks:
    """Return the records of a run that is simulated again from its spec, its program's commands and its user actions.

    Args:
        spec: The run, as it began.
        commands: The program's commands in their order, as `RecordedCommands.unpack` yields them.
        actions: The user's actions, in the order of the ticks.
        last_tick: The last tick to simulate.
        limit_s: Seconds of processor time that the simulation may take.

    Raises:
        LogError: no program can have given these commands, or the simulation takes too long.
    """
    ticks = MemoryRecording()
    motors = _Motors(spec.robot)
    sim = build_simulation(spec, NoRecording())
    sim.restart(spec, ticks, motors if sim.notices else None)
    advance = _build_advance(sim, actions)
    check = CommandCheck(sim)
    give_up_s = thread_time() + limit_s
    for number, command in enumerate(commands):
        if not number % _LOOK_EVERY and thread_time() > give_up_s:
            raise LogError(f"what the program did takes more than {limit_s:g} s to replay")
        tick = sim.count_ticks(command.time_ns)
        fault = check.find_disorder(command.time_ns)
        if tick > last_tick:
            fault = "is after the end of the run"
        if not fault:
            advance(tick)
            fault = check.find_fault(command)
        if fault:
            time_s = command.time_ns / NS_PER_S
            raise LogError(f"at {time_s:.2f} s there is a command that {fault}")
        give_command(sim, command)
    advance(last_tick)
    return ReplayedTicks(
        ticks.buffer[HEADER_BYTES : HEADER_BYTES + TICK_RECORD.size * ticks.count],
        motors.buffer[HEADER_BYTES : HEADER_BYTES + motors.tick_bytes * ticks.count]
        if sim.notices
        else bytearray(),
        motors.tick_bytes,
        sim.spec.robot,
    )


def give_command(sim: Simulation, command: SimulationCommand) -> None:
    """Give a recorded command to a simulation.

    An error of the command is ignored, because in the run it was raised in the program.
    """
    time_ns, part, call, values = command
    try:
        obey(sim, time_ns, part, call, *values[: len(CALLS[call].ranges)])
    except Exception:  # Any error ends the command, as it did in the run.
        return


def _build_advance(sim: Simulation, actions: Iterable[UserAction]) -> Callable[[int], None]:
    """Return a function that advances a simulation to a given tick, and applies the user's actions at their ticks."""
    script = deque(action for action in actions if not isinstance(action.command, Stop))

    def advance(tick: int) -> None:
        while sim.tick < tick:
            while script and script[0].tick <= sim.tick:
                change_simulation(sim, script.popleft().command)
            until = min(tick, script[0].tick) if script else tick
            sim.advance(until - sim.tick)

    return advance


def replay_run(
    run: StoredRun, actions: Sequence[UserAction], limit_s: float = inf
) -> tuple[StoredRun, str]:
    """Simulate an ended run again, and replace its recording by the result where they differ.

    The recorded lines of the program and its output stay unchanged.

    Args:
        run: The run.
        actions: The user's actions, as known to the process that started the run.
        limit_s: Seconds of processor time that the simulation may take.

    Returns:
        The run with the new ticks and actions, and a text: the time from which its recording differed, such as `1.50
        s`; empty if it did not differ.

    Raises:
        LogError: the commands are damaged, no program can have given them, they take too long, or the result cannot be
            written.
    """
    import numpy as np

    recorded = run.telemetry.array()
    if not len(recorded):
        return run, ""
    last_tick = len(recorded) - 1
    ticks = _replay_commands(run, actions, last_tick, limit_s)
    records = np.frombuffer(ticks.telemetry, recorded.dtype)
    records["line"] = recorded["line"]
    done = tuple(action for action in actions if action.tick < last_tick)
    parted = min(_find_parting(records, recorded), _find_motor_parting(run, ticks))
    if parted > last_tick and run.actions == done:
        return run, ""
    try:
        _replace_files(run, ticks, done)
    except OSError as error:
        raise LogError(f"cannot be written: {error.strerror}", file=str(run.folder)) from error
    run = replace(run, telemetry=TelemetryView(run.folder), actions=done)
    run.telemetry.hold()
    if run.telemetry.array().tobytes() != ticks.telemetry:
        raise LogError("was changed after its end", file=str(run.folder))
    return (
        run,
        f"{compute_due_ns(min(parted, last_tick), run.spec.profile.tick_hz) / NS_PER_S:.2f} s",
    )


def _replay_commands(
    run: StoredRun, actions: Sequence[UserAction], last_tick: int, limit_s: float
) -> ReplayedTicks:
    commands = read_commands(run.folder)
    if commands.left_out:
        raise LogError(f"the program gave more than {len(commands.rows):,} commands")
    try:
        ticks = replay(run.first_spec, commands.unpack(), actions, last_tick, limit_s)
    except ValueError as error:
        raise LogError("damaged: the records are not commands", file=str(run.folder)) from error
    if ticks.robot != run.spec.robot:
        raise LogError("the robot's parts differ from those that the program has reported")
    return ticks


def _find_parting(records: Array, recorded: Array) -> int:
    """Return the first tick at which two recordings differ; the number of records if they are equal."""
    import numpy as np

    if records.tobytes() == recorded.tobytes():
        return len(records)
    differ = np.zeros(len(records), np.bool_)
    for name, _ in TICK_FIELDS:
        differ |= records[name] != recorded[name]
    return int(np.argmax(differ)) if differ.any() else len(records)


def _find_motor_parting(run: StoredRun, ticks: ReplayedTicks) -> int:
    """Return the first tick at which the records of the motors differ; the number of ticks if none do."""
    import numpy as np

    count = len(ticks.telemetry) // TICK_RECORD.size
    if not has_driver(run.spec):
        return count
    try:
        recorded = read_regular(run.folder / MOTORS_FILE, HEADER_BYTES + 2 * len(ticks.motors))
    except OSError:
        return 0
    recorded = recorded[HEADER_BYTES:]
    if recorded == ticks.motors:
        return count
    common = min(len(recorded), len(ticks.motors))
    parts = (np.frombuffer(data, np.uint8, common) for data in (recorded, ticks.motors))
    differ = np.not_equal(*parts)
    return (int(np.argmax(differ)) if differ.any() else common) // ticks.motor_bytes


def _replace_files(run: StoredRun, ticks: ReplayedTicks, actions: Sequence[UserAction]) -> None:
    """Replace the run's files of ticks, motors and user actions."""
    count = len(ticks.telemetry) // TICK_RECORD.size
    begin = pack_header(TELEMETRY_MAGIC, TICK_RECORD.size, count)
    _replace_file(run.folder / TELEMETRY_FILE, begin, ticks.telemetry)
    if has_driver(run.spec):
        begin = pack_header(MOTORS_MAGIC, ticks.motor_bytes, count)
        _replace_file(run.folder / MOTORS_FILE, begin, ticks.motors)
    lines = (json.dumps(action.to_plain()).encode() + b"\n" for action in actions)
    _replace_file(run.folder / ACTIONS_FILE, *lines)


def _replace_file(path: Path, *parts: bytes | bytearray) -> None:
    with replacing(path, durable=False, owner_only=True, follow_links=False) as file:
        for part in parts:
            file.write(part)
