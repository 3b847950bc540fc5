"""What the EV3 has under version 4: programs with its own names."""

from __future__ import annotations

import pytest

from tests.engine.shim.conftest import RunOn
from tuisim.engine.runs.records import Stream

PROFILE = "pybricks4"
HEAD = """
from pybricks.hubs import EV3Brick
from pybricks.parameters import Button, Color
from pybricks.tools import StopWatch, wait
ev3 = EV3Brick()
"""


def lights(run_on: RunOn, text: str) -> list[tuple[int, str]]:
    """Return the times in ms, and what the light of the brick showed."""
    done = run_on(HEAD + text, profile=PROFILE)
    assert not done.errors
    rows = [row for row in done.run.output.read_all_rows() if row.stream == Stream.LED]
    return [(row.time_ns // 1_000_000, row.text) for row in rows]


def test_the_bricks_light_blinks_until_it_is_set_again(run_on: RunOn) -> None:
    shown = lights(
        run_on,
        "ev3.light.off()\nev3.light.blink(Color.RED, [100, 50])\nwait(330)\nev3.light.off()\nwait(500)",
    )
    assert [time for time, _ in shown[1:]] == [0, 100, 150, 250, 300, 330]
    assert len({text for _, text in shown[1:]}) == 2


def test_an_animated_light_shows_its_colours_in_turn(run_on: RunOn) -> None:
    text = "ev3.light.animate([Color.GREEN, Color(20, 90, 90)], 100)\nwait(350)\nev3.light.on(Color.BLUE)\nwait(300)"
    times = [time for time, _ in lights(run_on, text)]
    assert times[-4:] == [100, 200, 300, 350]


@pytest.mark.parametrize(
    "call", ["blink(Color.RED, [])", "animate([Color.RED], 0)", "blink(Color.RED, [5, 0])"]
)
def test_an_animation_of_the_light_without_times_or_colours_is_refused(
    run_on: RunOn, call: str
) -> None:
    done = run_on(f"{HEAD}ev3.light.{call}", profile=PROFILE)
    assert done.errors[-1] == "ValueError: Invalid argument"


def test_a_button_stops_the_program_if_it_is_chosen(run_on: RunOn) -> None:
    text = "ev3.system.set_stop_button(Button.CENTER)\nwhile True:\n    ev3.buttons.pressed()\n    wait(10)"
    done = run_on(HEAD + text, profile=PROFILE, presses=("enter@0.5-1",))
    assert not done.errors
    assert 450 <= done.ended.time_ns // 1_000_000 <= 600


@pytest.mark.parametrize(
    "text, lines",
    [
        ("from pybricks import version\nprint(version[:2])", ["('ev3', '4.0.0')"]),
        ("from pybricks.hubs import ThisHub\nprint(ThisHub is EV3Brick)", ["True"]),
        (
            "ev3.speaker.volume(40)\nev3.speaker.beep(440, 200)\nev3.speaker.play_notes(['C4/4'], 240)\n"
            "print(ev3.speaker.volume())",
            ["40"],
        ),
        ("print(ev3.system.name(), ev3.system.info()['name'])", ["EV3 EV3"]),
        ("watch = StopWatch()\nwatch.pause()\nprint(watch.running())", ["False"]),
        ("from pybricks.tools import read_input_byte\nprint(read_input_byte())", ["None"]),
        (
            "from pybricks.parameters import Axis, Font, Image, ImageFile, Side\n"
            "from pybricks.tools import Matrix, cross, vector\n"
            "print(Side.TOP, cross(Axis.X, Axis.Y) == Axis.Z, Matrix([[1, 2]]).T.shape, vector(1, 2)[0])",
            ["Side.TOP True (2, 1) 1.0"],
        ),
        (
            "from pybricks.ev3devices import ColorSensor, GyroSensor\nfrom pybricks.parameters import Port\n"
            "gyro = GyroSensor(Port.S4)\ngyro.calibrate()\nprint(gyro.angle(), ev3.buttons.pressed())",
            ["0 set()"],
        ),
    ],
)
def test_names_that_only_pybricks_4_has_work_on_the_ev3(
    run_on: RunOn, text: str, lines: list[str]
) -> None:
    done = run_on(HEAD + text, profile=PROFILE)
    assert done.lines == lines, done.errors


@pytest.mark.parametrize(
    ("sound", "time_ms"),
    [("beep(440, 3000)", "3000"), ("play_notes(['C4/1', 'D4/1'])", "4000")],
)
def test_a_sound_lasts_although_a_motor_ends_its_move_before(
    run_on: RunOn, sound: str, time_ms: str
) -> None:
    text = (
        "from pybricks.ev3devices import Motor\nfrom pybricks.parameters import Port\n"
        "watch = StopWatch()\nMotor(Port.A).run_angle(500, 90, wait=False)\n"
        f"ev3.speaker.{sound}\nprint(watch.time())"
    )
    assert run_on(HEAD + text, robot="eyes", profile=PROFILE).lines == [time_ms]


def test_a_sound_that_takes_no_time_can_be_awaited(run_on: RunOn) -> None:
    text = (
        "from pybricks.tools import run_task\nasync def main():\n"
        "    await ev3.speaker.play_notes([])\n    await ev3.speaker.beep(440, -1)\n    print('done')\n"
        "run_task(main())"
    )
    assert run_on(HEAD + text, profile=PROFILE).lines == ["done"]


def test_a_sound_goes_on_although_its_task_is_closed(run_on: RunOn) -> None:
    text = (
        "from pybricks.tools import multitask, run_task\nasync def main():\n"
        "    await ev3.speaker.beep(440, 100)\n"
        "    await multitask(ev3.speaker.beep(880, 3000), wait(250), race=True)\nrun_task(main())"
    )
    done = run_on(HEAD + text, profile=PROFILE)
    assert not done.errors
    rows = [row for row in done.run.output.read_all_rows() if row.stream == Stream.SPEECH]
    assert [row.time_ns // 1_000_000 for row in rows] == [0, 100, 350]
    assert rows[-1].text == "[silence]"


def test_pressed_buttons_of_the_remote_are_returned_as_a_set(run_on: RunOn) -> None:
    text = (
        "from pybricks.ev3devices import InfraredSensor\nfrom pybricks.parameters import Port\n"
        "remote = InfraredSensor(Port.S3)\nprint(remote.buttons(1), remote.keypad())"
    )
    assert run_on(HEAD + text, robot="eyes", profile=PROFILE).lines == ["set() set()"]


def test_using_motor_model_is_refused_as_not_simulated(run_on: RunOn) -> None:
    text = "from pybricks.ev3devices import Motor\nfrom pybricks.parameters import Port\nMotor(Port.B).model.state()"
    errors = run_on(HEAD + text, profile=PROFILE).errors
    assert errors[-1].startswith("NotSimulated: Motor.model.state: the model of a motor")


@pytest.mark.parametrize(
    ("line", "error"),
    [
        ("from pybricks.tools import DataLog", "pybricks.tools.DataLog is not in Pybricks 4"),
        ("from pybricks.parameters import SoundFile", "has beep() and play_notes()"),
        (
            "from pybricks.media.ev3dev import Font",
            "Image, Font and ImageFile are in pybricks.parameters",
        ),
        ("from pybricks.experimental import run_parallel", "use multitask() and run_task()"),
        ("from pybricks.messaging import TextMailbox", "is not in Pybricks 4"),
        (
            "import pybricks.ev3brick as brick\nbrick.sound.beep()",
            "use the class of the brick or hub in pybricks.hubs",
        ),
        ("ev3.speaker.say('hello')", "no attribute 'say': print() shows a text"),
        ("from pybricks.tools import Nothing", "cannot import name 'Nothing'"),
        ("from pybricks.robotics import Car\nCar()", "the class Car is not simulated"),
        ("from pybricks.parameters import Font, Image, ImageFile\n1 / 0", "division by zero"),
    ],
)
def test_names_of_the_earlier_pybricks_are_refused_with_what_replaces_them(
    run_on: RunOn, line: str, error: str
) -> None:
    assert error in run_on(HEAD + line, profile=PROFILE).errors[-1]


def test_names_of_the_earlier_version_can_be_imported_under_its_profile(run_on: RunOn) -> None:
    text = "from pybricks.tools import DataLog, localtime\nfrom pybricks.robotics import Stop, wait"
    assert not run_on(text, profile="lego-micropython").errors
