"""What a program waited for in vain, found in the recording of its run."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pytest

from tests.cases import cases
from tests.engine.runs.run_recorder import Recorder
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.profile import PROFILES
from tuisim.engine.core.remote_spec import RemotePress
from tuisim.engine.core.sensors.touch import find_hand_flags
from tuisim.engine.core.spec import InfraredSpec, Obstacle, RobotSpec, RunSpec, TouchSpec, WorldSpec
from tuisim.engine.protocol import End
from tuisim.engine.runs.records import READINGS_FILE, Stream
from tuisim.tasks.reasons.run_data import RunData
from tuisim.tasks.reasons.subjects import Subject
from tuisim.tasks.reasons.waited import find_awaited

Record = Callable[..., Recorder]
Moves = Callable[[Recorder], None]

ROBOT = RobotSpec(
    ultrasonic=None,
    gyro=None,
    touch_sensors=(TouchSpec(port="in1"),),
    infrared=InfraredSpec(port="in4"),
)
SPEC = RunSpec(ROBOT, WorldSpec(start=Pose(500.0, 571.5, 0.0)), PROFILES["ev3"])
AT_BOX = replace(SPEC.world, obstacles=(Obstacle(540.0, 500.0, 50.0, 143.0),))
WITH_REMOTE = replace(SPEC.world, remote=(RemotePress(("top_left",), 1.0, 2.0),))


def poll(recorder: Recorder, port: str, mode: str, line: int = 5, seconds: float = 7) -> None:
    """Read something every tenth of a second."""
    for _ in range(round(10 * seconds)):
        recorder.read(port, mode, line)
        recorder.simulation.line = line
        recorder.simulation.advance(10)


def press(recorder: Recorder, *names: str) -> None:
    recorder.simulation.press(find_hand_flags(names))
    recorder.act("set_buttons", pressed=names)


def press_for_a_moment(recorder: Recorder, name: str, port: str, mode: str) -> None:
    poll(recorder, port, mode, seconds=2)
    press(recorder, name)
    recorder.simulation.advance(1)
    poll(recorder, port, mode, seconds=1)
    press(recorder)
    recorder.simulation.advance(1)
    poll(recorder, port, mode)


def drive_and_poll(recorder: Recorder, port: str, mode: str) -> None:
    for _ in range(70):
        recorder.read(port, mode, 5)
        recorder.drive(100, -100, 10, 6)


def read_once_and_drive_on(recorder: Recorder) -> None:
    recorder.read("in2", "COL-REFLECT", 3)
    recorder.drive(100, 100, 300, 6)


def start_by_button_and_wait(recorder: Recorder) -> None:
    poll(recorder, "buttons", "pressed", line=3, seconds=2)
    poll(recorder, "in1", "TOUCH", line=8)


def read_touch_while_another_line_looks_at_colors(recorder: Recorder) -> None:
    for _ in range(70):
        recorder.read("in2", "COL-REFLECT", 12)
        recorder.read("in1", "TOUCH", 5)
        recorder.simulation.line = 5
        recorder.simulation.advance(10)


def sleep_after_reading(recorder: Recorder) -> None:
    poll(recorder, "buttons", "pressed", seconds=2)
    recorder.simulation.advance(600)


B = Subject.BUTTONS
T = Subject.TOUCH
R = Subject.REMOTE
C = Subject.COLOR

WAITS: dict[str, tuple[WorldSpec, Moves, list[tuple[Subject, str, int, str]]]] = {
    "buttons": (SPEC.world, lambda r: poll(r, "buttons", "pressed"), [(B, "buttons", 70, "")]),
    "touch": (SPEC.world, lambda r: poll(r, "in1", "TOUCH"), [(T, "in1", 70, "")]),
    "remote": (SPEC.world, lambda r: poll(r, "in4", "IR-REMOTE"), [(R, "in4", 70, "")]),
    "beacon": (SPEC.world, lambda r: poll(r, "in4", "IR-SEEK"), [(Subject.BEACON, "in4", 70, "")]),
    "wall": (
        replace(SPEC.world, walls=False),
        lambda r: poll(r, "in4", "IR-PROX"),
        [(Subject.PROXIMITY, "in4", 70, "100 %")],
    ),
    "connection": (
        SPEC.world,
        lambda r: poll(r, "socket", "accept"),
        [(Subject.CONNECTION, "socket", 70, "")],
    ),
    "line while it turns": (
        SPEC.world,
        lambda r: drive_and_poll(r, "in2", "COL-REFLECT"),
        [(C, "in2", 70, "white")],
    ),
    "touch while it turns": (
        SPEC.world,
        lambda r: drive_and_poll(r, "in1", "TOUCH"),
        [(T, "in1", 70, "")],
    ),
    "the second of two": (SPEC.world, start_by_button_and_wait, [(T, "in1", 70, "")]),
    "the call that it is in": (
        SPEC.world,
        read_touch_while_another_line_looks_at_colors,
        [(T, "in1", 70, "")],
    ),
    "a guard of a loop that drives": (
        SPEC.world,
        lambda r: drive_and_poll(r, "buttons", "pressed"),
        [],
    ),
    "a button that was pressed": (
        SPEC.world,
        lambda r: press_for_a_moment(r, "enter", "buttons", "pressed"),
        [],
    ),
    "a bumper that was pressed": (
        SPEC.world,
        lambda r: press_for_a_moment(r, "in1", "in1", "TOUCH"),
        [],
    ),
    "a remote that was pressed": (
        SPEC.world,
        lambda r: press_for_a_moment(r, "remote.left_up", "in4", "IR-REMOTE"),
        [],
    ),
    "a bumper at a box": (AT_BOX, lambda r: poll(r, "in1", "TOUCH"), []),
    "a remote of the world": (WITH_REMOTE, lambda r: poll(r, "in4", "IR-REMOTE"), []),
    "a sleep on purpose": (SPEC.world, sleep_after_reading, []),
    "a sensor that is read no more": (SPEC.world, read_once_and_drive_on, []),
    "a motor": (SPEC.world, lambda r: poll(r, "outB", "state"), []),
    "nothing": (SPEC.world, lambda r: None, []),
}


@cases("world, moves, awaited", WAITS)
def test_sensors_that_never_changed_are_what_a_run_waited_for(
    record: Record, world: WorldSpec, moves: Moves, awaited: list[tuple[Subject, str, int, str]]
) -> None:
    recorder = record(replace(SPEC, world=world))
    moves(recorder)
    found = find_awaited(RunData(recorder.end(End.TIME_LIMIT)))
    assert [(one.subject, one.port, one.times, one.value) for one in found] == awaited
    assert all(0.0 <= one.since_s <= recorder.simulation.tick / 100 for one in found)


@pytest.mark.parametrize(
    ("end", "seconds", "is_told"),
    [
        (End.STOPPED, 2, True),
        (End.STOPPED, 0.5, False),
        (End.FINISHED, 7, True),
        (End.FINISHED, 2, False),
        (End.RAISED, 7, False),
    ],
)
def test_only_a_run_that_was_stopped_or_stood_still_waited(
    record: Record, end: End, seconds: float, is_told: bool
) -> None:
    recorder = record(SPEC)
    poll(recorder, "in1", "TOUCH", seconds=seconds)
    assert bool(find_awaited(RunData(recorder.end(end)))) is is_told


GUARDED = "while not ts.is_pressed:\n    print(us.distance_centimeters)\n    sleep(0.1)\n"


@pytest.mark.parametrize(
    ("text", "sounds", "is_told"),
    [
        ("print(ts.is_pressed)\nprint(us.distance_centimeters)", False, False),
        ("while not ts.is_pressed:\n    sleep(0.1)\n", False, True),
        ("while not ts.is_pressed:\n    sleep(0.1)\n", True, False),
        (GUARDED, False, False),
        (f"{GUARDED}tank.on(50, 50)", False, True),
    ],
)
def test_a_program_that_logs_or_plays_sounds_is_not_said_to_wait_for_a_press(
    record: Record, text: str, sounds: bool, is_told: bool
) -> None:
    recorder = record(SPEC, text=text)
    for _ in range(70):
        recorder.read("in1", "TOUCH", 1)
        recorder.read("in2", "COL-REFLECT", 2)
        recorder.simulation.advance(10)
    if sounds:
        recorder.print("[tone 440 Hz 1.0 s]", stream=Stream.SPEECH)
    touched = [
        one for one in find_awaited(RunData(recorder.end(End.TIME_LIMIT))) if one.subject is T
    ]
    assert bool(touched) is is_told


def test_of_several_awaited_buttons_the_one_that_ends_the_program_is_advised_last(
    record: Record,
) -> None:
    recorder = record(SPEC, text="while not btn.backspace and not btn.up:\n    go()\nrun()")
    poll(recorder, "buttons", "pressed", line=1)
    assert find_awaited(RunData(recorder.end(End.TIME_LIMIT)))[0].sought == ("up", "backspace")


def test_without_recorded_readings_nothing_is_said_about_a_wait(record: Record) -> None:
    recorder = record(SPEC)
    poll(recorder, "in1", "TOUCH")
    run = recorder.end(End.TIME_LIMIT)
    (run.folder / READINGS_FILE).unlink()
    assert find_awaited(RunData(run)) == ()
