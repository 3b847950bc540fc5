"""A run is worked out again from what its program did: the same ticks come out, to the last bit."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import count
from math import inf, nan
from random import Random
from typing import Any

import pytest

from tests.engine.runs.random_programs import draw_program
from tests.running import Done, Run
from tuisim.base.errors import LogError
from tuisim.engine.core.commands.calls import MAX_VALUES, Call, SimulationCommand
from tuisim.engine.core.commands.table import CALLS
from tuisim.engine.core.profile import PROFILES
from tuisim.engine.core.spec import RobotSpec, RunSpec, WorldSpec
from tuisim.engine.core.tick_record import TICK_FIELDS
from tuisim.engine.protocol import End, SetButtons, SetNoise, SetPen, SetPose, UserAction
from tuisim.engine.runs.command_records import read_commands
from tuisim.engine.runs.records import HEADER_BYTES, MOTORS_FILE
from tuisim.engine.runs.replay import replay

ACTIONS = (
    UserAction(20, SetPose(700.0, 400.0, 30.0)),
    UserAction(40, SetButtons(("left",))),
    UserAction(60, SetPen(True)),
    UserAction(60, SetNoise(5, 30)),
)


def assert_is_replayed(done: Done, actions: Sequence[UserAction] = ()) -> None:
    import numpy as np

    folder = done.run.folder
    recorded = done.run.telemetry.array()
    commands = read_commands(folder)
    assert not commands.left_out
    ticks = replay(done.run.first_spec, commands.unpack(), actions, len(recorded) - 1)
    again = np.frombuffer(bytes(ticks.telemetry), recorded.dtype)
    assert len(again) == len(recorded)
    for field, _ in TICK_FIELDS:
        # The program's line is its own word.
        if field != "line":
            parts = np.flatnonzero(again[field] != recorded[field])
            assert not len(parts), f"{field} at tick {parts[0]}"
    if (folder / MOTORS_FILE).exists():
        assert (folder / MOTORS_FILE).read_bytes()[HEADER_BYTES:] == bytes(ticks.motors)


@pytest.mark.parametrize("profile", sorted(PROFILES))
def test_a_random_programs_run_is_replayed_to_the_same_records(run: Run, profile: str) -> None:
    text = draw_program(len(profile), profile)
    assert_is_replayed(run(text, profile=profile, prelude="none", seed=3))


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize("profile", sorted(PROFILES))
def test_runs_of_many_random_programs_are_replayed_to_the_same_records(
    run: Run, profile: str, seed: int
) -> None:
    how: dict[str, Any] = {"noise": (5, 20 * (seed % 3)), "solid": seed % 2 == 0, "seed": seed}
    actions = ACTIONS if seed % 4 == 0 else ()
    done = run(
        draw_program(100 + seed, profile), profile=profile, prelude="none", actions=actions, **how
    )
    assert_is_replayed(done, actions)


LARGE = """\
left = tank_drive.left_motor
for number in (10**15, -10**300):
    left.position = number
    for move in (left.run_forever, left.run_to_abs_pos, left.run_timed):
        try:
            move(position_sp=number, speed_sp=number, time_sp=number)
        except ValueError:
            left.run_forever(speed_sp=100)
        __import__('time').sleep(0.1)
"""
LARGE_OF_PYBRICKS = """\
from pybricks.ev3devices import Motor
from pybricks.parameters import Port
from pybricks.tools import wait
left = Motor(Port.B)
for number in (10**15, -10**300):
    left.reset_angle(number)
    left.run(200)
    wait(100)
"""


@pytest.mark.parametrize(
    "profile, text",
    [
        *((profile, LARGE) for profile in ("robolab", "ev3", "nbev3devsim")),
        *((profile, LARGE_OF_PYBRICKS) for profile in ("lego-micropython", "pybricks4")),
    ],
)
def test_a_program_with_numbers_that_are_too_large_is_replayed_and_not_called_falsified(
    run: Run, profile: str, text: str
) -> None:
    prelude = "preloaded" if text == LARGE else "none"
    done = run(text, profile=profile, prelude=prelude)
    assert done.ended.end == End.FINISHED
    assert_is_replayed(done)


def test_a_replay_repeats_the_users_actions(run: Run) -> None:
    done = run(draw_program(7, "robolab"), prelude="none", actions=ACTIONS)
    assert_is_replayed(done, ACTIONS)


def test_a_run_whose_commands_come_from_the_prelude_is_replayed(run: Run) -> None:
    assert_is_replayed(run("tank_drive.on_for_seconds(50, 20, 0.5)\n", profile="nbev3devsim"))


BASES = """\
from pybricks.ev3devices import Motor
from pybricks.parameters import Port
from pybricks.robotics import DriveBase
left, right = Motor(Port.B), Motor(Port.C)
for way in range(300):
    robot = DriveBase(left, right, 56, 114)
    if way % 100 == 99:
        robot.straight(100)
"""


def test_a_program_that_creates_a_drive_base_in_a_loop_is_replayed(run: Run) -> None:
    done = run(BASES, profile="lego-micropython", prelude="none")
    assert done.ended.summary == ""
    last = done.run.telemetry.last()
    assert last is not None and last.x_mm - done.run.spec.world.start.x_mm > 250
    assert_is_replayed(done)


ENDINGS = """\
from pybricks.ev3devices import Motor
from pybricks.parameters import Port, Stop
motor = Motor(Port.B)
for then in (Stop.NONE, Stop.COAST_SMART, Stop.BRAKE_SMART):
    motor.run_angle(500, 90, then=then)
"""


def test_each_ending_of_a_move_is_replayed(run: Run) -> None:
    done = run(ENDINGS, profile="pybricks4", prelude="none")
    assert done.ended.summary == ""
    assert_is_replayed(done)


# What no program can have given


def _replay(*commands: tuple[int, int, Call, tuple[float, ...]], profile: str = "robolab") -> None:
    spec = RunSpec(RobotSpec(), WorldSpec(), PROFILES[profile])
    replay(
        spec,
        (
            SimulationCommand(time_ns, part, call, values + (nan,) * (7 - len(values)))
            for time_ns, part, call, values in commands
        ),
        (),
        100,
    )


@pytest.mark.parametrize(
    ("command", "why"),
    [
        ((0, 0, Call.RUN, (1051.0,)), "has a value that is not allowed"),
        ((0, 0, Call.RUN, (nan,)), "has a value that is not allowed"),
        ((0, 0, Call.RUN_UNTIL, (1.0, inf)), "has a value that is not allowed"),
        ((0, 2, Call.STOP, ()), "is for a part that the robot does not have"),
        ((0, 0, Call.MOVE_BASE, (1.0, 1.0, 0.0)), "no motor of this profile takes"),
        ((2_000_000_000, 0, Call.STOP, ()), "is after the end of the run"),
    ],
)
def test_a_command_that_no_program_can_give_is_named(
    command: tuple[int, int, Call, tuple[float, ...]], why: str
) -> None:
    with pytest.raises(LogError, match=f"there is a command that {why}"):
        _replay(command)


def test_a_replay_refuses_commands_whose_time_goes_back() -> None:
    stop = Call.STOP, ()
    _replay((10, 0, *stop), (10, 1, *stop))
    with pytest.raises(LogError, match=r"at 0\.50 s there is a command that goes back in time"):
        _replay((600_000_000, 0, *stop), (500_000_000, 0, *stop))


def test_a_replay_that_takes_too_long_ends_with_an_error() -> None:
    spec = RunSpec(RobotSpec(), WorldSpec(), PROFILES["robolab"])

    def command() -> Iterator[SimulationCommand]:
        for time_ns in count():
            yield SimulationCommand(time_ns, 0, Call.STOP, (0.0,) * MAX_VALUES)

    with pytest.raises(LogError, match=r"takes more than 0\.2 s to replay"):
        replay(spec, command(), (), 100_000, limit_s=0.2)


def test_more_commands_than_their_time_allows_are_refused() -> None:
    stop = 0, Call.STOP, ()
    with pytest.raises(LogError, match=r"at 0\.10 s there is a command that the time is too short"):
        _replay(*[(100_000_000, *stop)] * 10_001)


ODD = (0.0, 0.5, 1.0, 2.0, 3.0, 100.0, 360.0, 1e6, 1e9, 2.0**53, 5e-324, 1e-300)
FASTEST_MM_S = 1000.0
"""No robot is so fast."""


def _draw_commands(random: Random, profile: str) -> list[SimulationCommand]:
    """Return commands in their order, with values that the record of commands may have."""
    law = PROFILES[profile].motor_law
    commands = []
    time_ns = 0
    calls = [call for call, spec in CALLS.items() if law in spec.laws]
    for _ in range(random.randint(1, 12)):
        time_ns += random.choice((0, 1, 10**6, 10**7, 10**8))
        call = random.choice(calls)
        values = [
            random.choice([one for odd in ODD for one in (odd, -odd) if low <= one <= high])
            if random.random() < 0.6
            else random.uniform(max(low, -2000.0), min(high, 2000.0))
            for low, high in CALLS[call].ranges
        ]
        if CALLS[call].may_be_missing and random.random() < 0.3:
            values[random.randrange(len(values))] = nan
        values += [0.0] * (MAX_VALUES - len(values))
        commands.append(SimulationCommand(time_ns, random.choice((0, 1)), call, tuple(values)))
    return commands


@pytest.mark.parametrize("profile", sorted(PROFILES))
def test_no_commands_break_the_simulation_or_the_laws_of_its_motors(profile: str) -> None:
    import numpy as np

    spec = RunSpec(RobotSpec(), WorldSpec(), PROFILES[profile])
    hz = spec.profile.tick_hz
    random = Random(29)
    for _ in range(60):
        commands = _draw_commands(random, profile)
        try:
            ticks = replay(spec, commands, (), commands[-1].time_ns * hz // 10**9 + hz)
        except LogError:
            continue
        records = np.frombuffer(bytes(ticks.telemetry), np.dtype(list(TICK_FIELDS)))
        ways_mm = np.hypot(np.diff(records["x_mm"]), np.diff(records["y_mm"]))
        assert np.all(ways_mm * hz < FASTEST_MM_S), commands
