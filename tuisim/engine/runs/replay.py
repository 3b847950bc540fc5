"""Works a run out again: its world, its user and the commands of its program make the same ticks, to the last bit."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from math import inf
from time import thread_time
from typing import TYPE_CHECKING

from tuisim.base.data_class import dataclass
from tuisim.base.errors import LogError
from tuisim.engine.core.commands.calls import SimulationCommand
from tuisim.engine.core.commands.check import CommandCheck
from tuisim.engine.core.commands.table import CALLS, obey
from tuisim.engine.core.motor_columns import MOTOR_RECORD, name_motors
from tuisim.engine.core.profile import NS_PER_S
from tuisim.engine.core.simulation import Simulation, build_simulation
from tuisim.engine.core.tick_record import TICK_RECORD, MemoryRecording, NoRecording
from tuisim.engine.protocol import Stop, UserAction
from tuisim.engine.runs.motor_records import arrange_records
from tuisim.engine.runs.records import HEADER_BYTES
from tuisim.engine.runs.user_changes import change_simulation

if TYPE_CHECKING:
    from tuisim.engine.core.spec import RobotSpec, RunSpec


_LOOK_EVERY = 1000
"""The time limit is checked once in this many commands."""


@dataclass(frozen=True, slots=True)
class ReplayedTicks:
    """The records that a run would have made."""

    telemetry: bytearray
    """A record for each tick, without a header; the lines of the program are 0."""
    motors: bytearray
    """The records of the motors for each tick; empty if they have no driver."""
    motor_bytes: int
    """Size of the motors' records of one tick."""
    robot: RobotSpec
    """The robot with all parts that were plugged in."""


class _Motors:
    """Records of motors in memory, in place of those of a `MotorsWriter`."""

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
    """Simulate a run again from its spec, the recorded commands of its program, and the user's actions.

    Args:
        spec: The run, as it began.
        commands: The program's commands in their order, with all values of their records.
        actions: The user's actions, in the order of the ticks.
        last_tick: The last tick to simulate.
        limit_s: Seconds of processor time that it may take.

    Raises:
        LogError: no program can have given these commands, or they take longer than they may.
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
    """Let a simulation obey a recorded command."""
    count = len(CALLS[command.call].ranges)
    # Whatever was raised in the program, here it ends the command, too.
    with suppress(Exception):
        obey(sim, command.time_ns, command.part, command.call, *command.values[:count])


def _build_advance(sim: Simulation, actions: Iterable[UserAction]) -> Callable[[int], None]:
    """Return a function that runs all ticks up to a tick, and the user's actions right before the ticks of these."""
    script = deque(action for action in actions if not isinstance(action.command, Stop))

    def advance(tick: int) -> None:
        while sim.tick < tick:
            while script and script[0].tick <= sim.tick:
                change_simulation(sim, script.popleft().command)
            until = min(tick, script[0].tick) if script else tick
            sim.advance(until - sim.tick)

    return advance
