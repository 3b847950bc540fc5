"""The commands of a run as events: grouped, named by their part, with what came of them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from tests.cases import cases
from tests.running import Run
from tuisim.engine.core.commands.calls import Call
from tuisim.engine.core.commands.robot import encode_parts
from tuisim.engine.core.plugged import PluggedPart
from tuisim.engine.core.spec import MotorSpec, RobotSpec
from tuisim.engine.runs import command_events
from tuisim.engine.runs.command_events import CommandIndex, parse_command_search
from tuisim.engine.runs.command_records import CommandsWriter
from tuisim.engine.runs.records import COMMANDS_FILE
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.engine.runs.store import RunStore

MS = 1_000_000

DRIVE = """\
from ev3dev2.motor import LargeMotor, OUTPUT_C
import time
right = LargeMotor(OUTPUT_C)
right.on_for_degrees(30, 360)
for speed in range(100):
    right.run_forever(speed_sp=200 + speed)
    time.sleep(0.01)
right.stop(stop_action='coast')
time.sleep(1)
"""
BASE = """\
from pybricks.ev3devices import Motor
from pybricks.parameters import Port
from pybricks.robotics import DriveBase
from pybricks.tools import wait
base = DriveBase(Motor(Port.B), Motor(Port.C), 56, 114)
base.straight(100)
base.turn(-90)
base.drive(50, 0)
wait(1000)
base.stop()
wait(200)
Motor(Port.B).run_target(200, 90)
"""
CAME = {
    "robolab": (
        DRIVE,
        "robolab",
        [
            "right motor C: run to 360° at 315 °/s → 360° by 1.3",
            "right motor C: run 200 … 299 °/s, 100 times until 2.",
            "right motor C: stop → turned ",
        ],
    ),
    "ev3": (
        DRIVE,
        "ev3",
        [
            "right motor C: run-to-rel-pos 360° at 315 °/s, then ",
            "right motor C: run-forever 200 … 299 °/s, 100 times until 2.",
            "right motor C: stop, coast → turned ",
        ],
    ),
    "lego-micropython": (
        BASE,
        "lego-micropython",
        [
            "drive base: build, wheels 56 mm, track 114 mm",
            "drive base: drive 100 mm, turn 0°, then hold → 10",
            "drive base: drive 0 mm, turn -90°, then hold → 0 mm, -5",
            "drive base: drive 50 mm/s, turn 0 °/s → mean 4",
            "drive base: stop, coast",
            "left motor B: run to 90° at 200 °/s → 90° by ",
        ],
    ),
}


def list_texts(run: Run, text: str, profile: str) -> list[str]:
    index = CommandIndex(run(text, profile=profile, prelude="none").run)
    index.read_all()
    events = [index.event(number) for number in index.find_events()]
    assert [event.time_s for event in events] == sorted(event.time_s for event in events)
    return [f"{event.part}: {event.words}" for event in events]


@cases("program, profile, beginnings", CAME)
def test_a_commands_event_shows_the_asked_and_the_reached_values(
    run: Run, program: str, profile: str, beginnings: list[str]
) -> None:
    left = iter(list_texts(run, program, profile))
    for beginning in beginnings:
        assert any(text.startswith(beginning) for text in left), beginning


@pytest.fixture
def stored(run: Run, tmp_path: Path) -> StoredRun:
    """A run of a second whose record of commands is still to be written."""
    done = run("import time\ntime.sleep(1)\n")
    return replace(RunStore().load_run(done.run.run_id), folder=tmp_path)


def write_commands(run: StoredRun, *commands: tuple[int, int, int, tuple[float, ...]]) -> None:
    (run.folder / COMMANDS_FILE).unlink(missing_ok=True)
    writer = CommandsWriter(run.folder)
    for command in commands:
        writer.add(*command)
    writer.close()


def test_a_command_repeated_quickly_is_one_event_however_it_is_read(
    stored: StoredRun, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(command_events, "_PIECE", 7)
    turns = [
        (10 * MS * number, part, Call.RUN, (float(speed),))
        for number in range(100)
        for part, speed in ((0, number), (1, -number))
    ]
    late = 2_000 * MS
    write_commands(stored, *turns, (late, 0, Call.STOP, ()), (late, 0, Call.RUN, (7.0,)))
    index = CommandIndex(stored)
    index.read_all()
    events = [index.event(number) for number in index.find_events()]
    assert [(event.part, event.asked, event.count) for event in events] == [
        ("left motor B", "run 0 … 99 °/s", 100),
        ("right motor C", "run -99 … 0 °/s", 100),
        ("left motor B", "stop", 1),
        ("left motor B", "run 7 °/s", 1),
    ]
    assert [tick for tick, _ in index.marks] == [0, 200]
    assert index.find_events("left stop") == index.find_events("STOP") == [2]
    assert events[0].words.startswith("run 0 … 99 °/s, 100 times until 0.99 s")
    assert index.find_events("right") == [1] and not index.find_events("pen")


def test_impossible_command_records_do_not_break_the_list_of_events(stored: StoredRun) -> None:
    index = CommandIndex(stored)
    assert not index.read_piece() and not len(index)
    write_commands(
        stored,
        (-5, 0, 200, ()),
        (1 << 62, 200, Call.RUN, (1e300,)),
        (5, 0, Call.PLUG, (1e15, -3.0, 2.5)),
        (5, 77, Call.MOVE_BASE, (float("nan"),) * 7),
        (5, 0, Call.FOLLOW, (-1.0,)),
    )
    index.read_all()
    texts = [str(index.event(number).words) for number in index.find_events()]
    assert texts == ["run 1e+300 °/s", "plug", "drive nan mm, turn nan°, then nan", "then -1"]
    (stored.folder / COMMANDS_FILE).write_bytes(b"nothing")
    assert index.event(0).asked.startswith("run") and not index.read_piece()


def test_a_motor_has_the_port_that_it_was_plugged_in_at(stored: StoredRun) -> None:
    plug = (0, 0, Call.PLUG, encode_parts([PluggedPart("outD", "LargeMotor", 0, 0)]))
    write_commands(stored, (0, 2, Call.STOP, ()), plug, (0, 2, Call.RUN, (50.0,)))
    index = CommandIndex(stored)
    index.read_all()
    events = [index.event(number) for number in index.find_events()]
    assert [event.part for event in events] == ["motor", "ports", "motor D"]
    assert (events[2].asked, events[2].came) == ("run 50 °/s", "")


def test_the_motors_of_the_robot_are_not_listed_for_each_command(
    stored: StoredRun, monkeypatch: pytest.MonkeyPatch
) -> None:
    motors = stored.spec.robot.motors
    lists: list[RobotSpec] = []

    def list_motors(robot: RobotSpec) -> tuple[MotorSpec, ...]:
        lists.append(robot)
        return motors

    write_commands(stored, *[(0, 0, Call.SET_POLARITY, (float(n % 2),)) for n in range(100)])
    index = CommandIndex(stored)
    monkeypatch.setattr(RobotSpec, "motors", property(list_motors))
    index.read_scale_changes()
    assert len(index.scale_changes) == 99
    assert len(lists) == 1


def test_a_command_event_uses_the_motors_latest_direction_and_gears(stored: StoredRun) -> None:
    tick_ns = 1_000_000_000 // stored.spec.profile.tick_hz
    write_commands(
        stored,
        (0, 0, Call.SET_UP, (-1.0, 1.0, 0.0)),
        (tick_ns, 1, Call.SET_UP, (1.0, 4.0, 0.0)),
        (9 * tick_ns, 0, Call.SET_UP, (1.0, 1.0, 0.0)),
        (9 * tick_ns, 0, Call.SET_UP, (0.0, 1.0, 0.0)),
        (9 * tick_ns, 99, Call.SET_UP, (1.0, 1.0, 0.0)),
    )
    index = CommandIndex(stored)
    index.read_all()
    assert index.find_scales(0) == {"outB": -1.0}
    assert index.find_scales(8) == {"outB": -1.0, "outC": 0.25}
    assert index.find_scales(9) == {"outB": 1.0, "outC": 0.25}


POLARITY = """\
import time
from ev3dev2.motor import LargeMotor, OUTPUT_C
right = LargeMotor(OUTPUT_C)
right.polarity = "inversed"
right.on_for_degrees(30, 90)
right.reset()
time.sleep(1)
"""


@pytest.mark.parametrize("profile", ["robolab", "ev3"])
def test_a_motor_counts_with_the_polarity_of_its_program_until_it_is_reset(
    run: Run, profile: str
) -> None:
    stored = run(POLARITY, profile=profile, prelude="none").run
    index = CommandIndex(stored)
    index.read_all()
    asked = [(event.time_s, event.asked) for event in map(index.event, index.find_events())]
    (begin_s, _), (end_s, end) = [event for event in asked if "polarity" in event[1]]
    assert end == "set polarity normal"
    hz = stored.spec.profile.tick_hz
    assert index.find_scales(round(begin_s * hz) + 1) == {"outC": -1.0}
    assert index.find_scales(round(end_s * hz) + 1) == {"outC": 1.0}


def test_events_beyond_the_limit_are_left_out(
    stored: StoredRun, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(command_events, "_MAX_EVENTS", 3)
    write_commands(stored, *((number * 1000 * MS, 0, Call.RUN, (1.0,)) for number in range(9)))
    index = CommandIndex(stored)
    index.read_all()
    assert len(index) == 3


def test_parse_command_search_reads_only_words_that_begin_with_command() -> None:
    texts = ("command", " Command  run to ", "commands", "command < 5", "sample command")
    assert [parse_command_search(text) for text in texts] == ["", "run to", None, "< 5", None]
