"""What a run waited for, in words: of real programs, as they are run."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path

import pytest

from tests.cases import cases, for_each
from tests.conftest import Command
from tuisim.engine.core.profile import PROFILES
from tuisim.engine.core.sensors.color import measure_color
from tuisim.engine.core.spec import RobotSpec, RunSpec, WorldSpec
from tuisim.engine.core.state import Instant
from tuisim.engine.mats import background
from tuisim.engine.runs.run_folder import field_files
from tuisim.tasks.reasons.hand_presses import HandPress
from tuisim.tasks.reasons.subjects import Subject
from tuisim.tasks.reasons.waited import Awaited
from tuisim.tasks.reasons.waited_words import (
    COLOR_PLACES_MM,
    COLORED_MAT,
    describe_awaited,
    describe_wait_with_keys,
    name_remedy,
)

SPEC = RunSpec(RobotSpec(), WorldSpec(), PROFILES["ev3"])

_TIMES = re.compile(r"[\d,]+ times")
"""How often a program reads depends on the costs of a profile."""

WAIT_BUTTON = """
from ev3dev2.button import Button
from ev3dev2.motor import MoveTank, OUTPUT_A, OUTPUT_D
btn = Button()
tank = MoveTank(OUTPUT_A, OUTPUT_D)
print("Press a button to start")
while not btn.any():
    pass
tank.on_for_rotations(30, 30, 2)
"""
WAIT_TOUCH = """
from ev3dev2.sensor.lego import TouchSensor
from ev3dev2.motor import MoveTank, OUTPUT_A, OUTPUT_D
ts = TouchSensor()
tank = MoveTank(OUTPUT_A, OUTPUT_D)
ts.wait_for_pressed()
tank.on_for_rotations(30, 30, 2)
"""
REMOTE = """
from ev3dev2.sensor.lego import InfraredSensor
from ev3dev2.motor import MoveTank, OUTPUT_B, OUTPUT_C
ir = InfraredSensor()
tank = MoveTank(OUTPUT_B, OUTPUT_C)
while True:
    if ir.top_left(1):
        tank.on(30, 30)
    else:
        tank.off()
"""
FOLLOW = """
from ev3dev2.sensor.lego import ColorSensor
from ev3dev2.motor import MoveSteering, OUTPUT_B, OUTPUT_C
cs = ColorSensor()
steer = MoveSteering(OUTPUT_B, OUTPUT_C)
while True:
    error = cs.reflected_light_intensity - 45
    steer.on(max(-100, min(100, error)), 20)
"""
ACCEPT = """
import socket
server = socket.socket()
server.bind(("localhost", 0))
server.listen()
server.accept()
"""
PLAY = """
from time import sleep
from ev3dev2.sound import Sound
while True:
    Sound().beep()
    sleep(2)
"""

WAIT_HUB = """
from pybricks.hubs import PrimeHub
from pybricks.parameters import Button
from pybricks.tools import wait
hub = PrimeHub()
while Button.LEFT not in hub.buttons.pressed():
    wait(10)
"""
WAIT_FORCE = """
from pybricks.parameters import Port
from pybricks.pupdevices import ForceSensor
from pybricks.tools import wait
bumper = ForceSensor(Port.E)
while not bumper.pressed():
    wait(10)
"""

MENU = """
from ev3dev2.button import Button
button = Button()
while not button.enter:
    if button.up:
        print("up")
    elif button.down:
        print("down")
"""
SERVE = """
from http.server import BaseHTTPRequestHandler, HTTPServer
HTTPServer(("127.0.0.1", 0), BaseHTTPRequestHandler).serve_forever()
"""
SELECT = """
import select, socket
with socket.socket() as server:
    server.listen()
    while True:
        if select.select([server], [], [], 0.1)[0]:
            break
"""

PROGRAMS = {
    "button": (
        WAIT_BUTTON,
        "read the brick's buttons N times, none was pressed: --press enter@1, or K in the app",
    ),
    "a menu": (
        MENU,
        "read the brick's buttons enter, up and down N times, none was pressed: --press enter@1, or K in the app",
    ),
    "touch": (WAIT_TOUCH, "touch sensor on in1 was never pressed: --press in1@2"),
    "button of a hub": (
        WAIT_HUB,
        "read the hub's buttons N times, none was pressed: --press left@1, or K in the app",
    ),
    "force": (WAIT_FORCE, "force sensor on E was never pressed: --press E@2"),
    "remote": (
        REMOTE,
        "infrared sensor on in1: no button of the remote was pressed: --press remote.left_up@2-4",
    ),
    "line": (
        FOLLOW,
        "colour sensor on in2 saw only white: -b Loop gives it a line (tuisim backgrounds)",
    ),
    "socket": (
        ACCEPT,
        "a server in line 6: nobody connected: --speed 1 gives the other program time to connect",
    ),
    "a server": (
        SERVE,
        "a server in line 3: nobody connected: --speed 1 gives the other program time to connect",
    ),
    "a server that looks at times": (
        SELECT,
        "a server in line 6: nobody connected: --speed 1 gives the other program time to connect",
    ),
    "on purpose": (PLAY, ""),
}


@cases("text, sentence", PROGRAMS)
def test_the_last_line_and_json_of_run_say_what_the_program_waited_for(
    tmp_path: Path, here: Command, text: str, sentence: str
) -> None:
    (tmp_path / "prog.py").write_text(text)
    done = here("run", "prog.py", "--timeout", 6)
    assert done.returncode == 3
    last = _TIMES.sub("N times", done.stderr)
    assert (f" · {sentence} · 0 samples" if sentence else "° · 0 samples") in last
    done = here("run", "prog.py", "--timeout", 6, "--json")
    assert _TIMES.sub("N times", json.loads(done.stdout)["waited_for"]) == sentence


RED = """
from ev3dev2.sensor.lego import ColorSensor
cs = ColorSensor()
while cs.color != ColorSensor.COLOR_RED:
    pass
"""
HAND = """
from time import sleep
from ev3dev2.sensor.lego import UltrasonicSensor
us = UltrasonicSensor()
while us.distance_centimeters > 8:
    sleep(0.5)
"""
TWO = """
from ev3dev2.button import Button
btn = Button()
while not (btn.up and btn.left):
    pass
"""
SECOND = """
from time import sleep
from ev3dev2.button import Button
sleep(2.5)
Button().wait_for_pressed("down")
"""
SLOW = """
from time import sleep
from ev3dev2.sensor.lego import TouchSensor
touch = TouchSensor()
while not touch.is_pressed:
    print("waiting")
    sleep(0.7)
"""
PAD = """
import evdev
from time import sleep
while len(evdev.list_devices()) < 2:
    sleep(1)
"""
GIVEN = {
    "any button": (WAIT_BUTTON, "--press enter@1"),
    "one button, later": (SECOND, "--press down@3"),
    "two buttons at once": (TWO, "--press up@1-2 --press left@1-2"),
    "touch": (WAIT_TOUCH, "--press in1@2"),
    "a slow look at touch": (SLOW, "--press in1@2-3"),
    "a colour": (RED, "-b Rainbow_bands -x 240"),
    "a hand": (HAND, "-o Central_post -x 824"),
}


@cases("text, options", GIVEN)
def test_the_option_advised_for_a_wait_ends_it(
    tmp_path: Path, here: Command, text: str, options: str
) -> None:
    (tmp_path / "prog.py").write_text(text)
    facts = json.loads(here("run", "prog.py", "--timeout", 6, "--json").stdout)
    assert re.search(f"[:;] {options}", facts["waited_for"])
    facts = json.loads(here("run", "prog.py", *options.split(), "--json").stdout)
    assert (facts["state"], facts["waited_for"]) == ("finished", "")


TWICE = """
from time import sleep
from ev3dev2.button import Button
b = Button()
while not b.enter: sleep(0.01)
while b.enter: sleep(0.01)
while not b.enter: sleep(0.01)
"""
VAIN = {
    "too early": (
        SECOND,
        "down@1",
        "down was pressed at 1 s, before the program first checked (at 2.5 s): --press down@3",
    ),
    "another button": (SECOND, "enter@3", "only enter was pressed, not down: --press down@3"),
    "one of two": (TWO, "left@1", "only left was pressed, not up: --press up@1-2 --press left@1-2"),
    "another sensor": (
        WAIT_TOUCH,
        "in2@1",
        "touch sensor on in1: only in2 was pressed: --press in1@2",
    ),
    "once of twice": (
        TWICE,
        "enter@0.5",
        "enter was pressed at 0.5 s, and the program waits for more: add --press enter@1",
    ),
    "between two checks": (
        SLOW,
        "touch@1.1-1.3",
        "touch sensor on in1: touch was pressed at 1.1 s, between two checks (0.7 s apart):",
    ),
}


@cases("text, press, sentence", VAIN)
def test_a_press_that_did_not_end_the_wait_is_named(
    tmp_path: Path, here: Command, text: str, press: str, sentence: str
) -> None:
    (tmp_path / "prog.py").write_text(text)
    done = here("run", "prog.py", "--press", press, "--timeout", 6, "--json")
    assert json.loads(done.stdout)["waited_for"].startswith(sentence)


ULTRASONIC = "from ev3dev2.sensor.lego import UltrasonicSensor\nus = UltrasonicSensor()\n"
INFRARED = "from ev3dev2.sensor.lego import InfraredSensor\nir = InfraredSensor()\n"
GYRO = "from ev3dev2.sensor.lego import GyroSensor\ng = GyroSensor()\n"
TONES = "from ev3dev2.sound import Sound\ns = Sound()\n"
TURNS = "from ev3dev2.motor import *\nMoveTank(OUTPUT_B, OUTPUT_C).on(10, -10)\n"
MEASURED = {
    "an obstacle around": (
        f"{ULTRASONIC}{TURNS}while us.distance_centimeters > 25: pass",
        "from 0.01 s on, line 5 waited for us on in1 to read 25 cm or less: 55.1",
    ),
    "a band, by a robot that spins": (
        "# %%sim_magic_preloaded -b Grey_bands\ntank_drive.on(30, -30)\n"
        "while colorLeft.reflected_light_intensity_pc > 5: pass",
        "from 0.01 s on, line 3 waited for colorLeft on in2 to read 5 % or less: it stayed at 100; "
        "the robot only turns on the spot",
    ),
    "nearer than a wall": (
        f"{ULTRASONIC}STOP_CM = 0.2\nwhile us.distance_centimeters > STOP_CM: pass",
        "from 0.01 s on, line 4 waited for us on in1 to read 0.2 cm or less: it stayed "
        "at 116.1; at a wall it reads 3 cm, never less",
    ),
    "away from a wall": (
        f"{ULTRASONIC}from ev3dev2.motor import *\nMoveTank(OUTPUT_A, OUTPUT_B).on(-30, -30)\n"
        "while us.distance_centimeters > 20: pass",
        "from 0.01 s on, line 5 waited for us on in1 to read 20 cm or less: it went from 116.1 to "
        "222.2, the other way; turn the signs of the speeds round",
    ),
    "the way is not free": (
        f"{ULTRASONIC}while us.distance_centimeters < 250: pass",
        "from 0.01 s on, line 3 waited for us on in1 to read 250 cm or more: it stayed",
    ),
    "tones of a distance": (
        f"{INFRARED}{TONES}while True: s.play_tone(200 + 8 * ir.proximity, 0.3)",
        "",
    ),
    "a turn": (
        f"{GYRO}while g.angle < 90: pass",
        "g on in4 was never turned: only its motors turn this robot",
    ),
    "an obstacle for a state": (
        f"{ULTRASONIC}state = 0\nwhile state < 2:\n    if us.distance_centimeters < 20: state = 2\n",
        "us on in1 saw nothing nearer than 116 cm",
    ),
    "nearer than a wall, by a state": (
        f"{ULTRASONIC}state = 0\nwhile state < 2:\n    if us.distance_centimeters < 2: state = 2\n",
        "us on in1 saw nothing nearer than 116 cm: at a wall it reads 3 cm, never less",
    ),
    "the largest turn": (f"{GYRO}m = 0\nwhile True:\n    if g.angle > m: m = g.angle\n", ""),
    "a note of what is near": (
        f"{ULTRASONIC}while True:\n    if us.distance_centimeters < 5: print('near')\n",
        "",
    ),
    "a turn that comes": (
        f"{GYRO}{TURNS}while g.angle < 9000: pass",
        "from 0.01 s on, line 5 waited for g on in4 to read 9000° or more: it went from 0 to",
    ),
}


@cases("text, sentence", MEASURED)
def test_a_reading_that_never_came_is_named_with_how_near_it_came(
    tmp_path: Path, here: Command, text: str, sentence: str
) -> None:
    (tmp_path / "prog.py").write_text(text)
    waited_for = json.loads(here("run", "prog.py", "--timeout", 9, "--json").stdout)["waited_for"]
    assert waited_for.startswith(sentence) and bool(waited_for) == bool(sentence)


@pytest.mark.slow
def test_a_wait_spread_over_thousands_of_lines_is_found_by_its_readings(
    tmp_path: Path, here: Command
) -> None:
    lines = "    v = us.distance_centimeters\n    if v < 5: v = 1\n" * 1500
    (tmp_path / "prog.py").write_text(f"{ULTRASONIC}while True:\n{lines}")
    facts = json.loads(here("run", "prog.py", "--timeout", 6, "--json").stdout)
    assert facts["waited_for"].startswith("us on in1 saw nothing nearer than")


def test_a_gamepad_that_never_comes_is_named(tmp_path: Path, here: Command) -> None:
    (tmp_path / "prog.py").write_text(PAD)
    facts = json.loads(here("run", "prog.py", "--timeout", 6, "--json").stdout)
    assert facts["waited_for"].startswith("looked for a gamepad 7 times, none is simulated: ")


def test_a_menu_after_one_press_is_said_to_wait_for_the_other_buttons(
    tmp_path: Path, here: Command
) -> None:
    (tmp_path / "prog.py").write_text(MENU)
    done = here("run", "prog.py", "--press", "up@1", "--timeout", 9, "--json")
    assert json.loads(done.stdout)["waited_for"] == (
        "up was pressed at 1 s, and the program waits for more: add --press enter@2, or K in the app"
    )


def test_the_remote_drives_while_it_is_pressed(tmp_path: Path, here: Command) -> None:
    (tmp_path / "prog.py").write_text(REMOTE)
    done = here("run", "prog.py", "--press", "remote.left_up@1-3", "--timeout", 9, "--json")
    facts = json.loads(done.stdout)
    assert 1181 + 250 < facts["x_mm"] < 1181 + 400
    assert facts["waited_for"] == ""


@pytest.mark.slow
def test_a_batch_has_a_column_of_what_each_run_waited_for(tmp_path: Path, here: Command) -> None:
    (tmp_path / "prog.py").write_text(WAIT_TOUCH)
    here("batch", "prog.py", "--seeds", "0..1", "--timeout", 6, "--out", "rows.csv")
    header, first, _ = (tmp_path / "rows.csv").read_text().splitlines()
    assert "waited_for" in header.split(",")
    assert "touch sensor on in1 was never pressed: --press in1@2" in first


@for_each(subject=Subject)
def test_each_kind_of_awaited_sensor_or_press_has_a_sentence_and_an_advice(
    subject: Subject,
) -> None:
    port = "buttons" if subject is Subject.BUTTONS else "in4"
    awaited = Awaited(subject, port, 3, 0.5, 7, "12 cm")
    assert describe_awaited(awaited) and name_remedy(awaited, SPEC)
    assert describe_wait_with_keys([awaited], SPEC).startswith(describe_awaited(awaited))


@pytest.mark.parametrize(("port", "key"), [("remote", "remote.left_plus"), ("xbox", "xbox.a")])
def test_the_key_of_a_controller_is_named_for_the_shell_and_for_the_app(
    port: str, key: str
) -> None:
    awaited = Awaited(Subject.BUTTONS, port, 3, 0.5, 7, sought=(key,))
    assert name_remedy(awaited, SPEC) == f"--press {key}@1, or K in the app"
    assert f"the mouse presses {key}" in describe_wait_with_keys([awaited], SPEC)


def test_buttons_awaited_together_are_advised_to_be_pressed_together() -> None:
    up = HandPress("up", 1.0, 1.1)
    left = HandPress("left", 3.0, 3.1)
    awaited = Awaited(
        Subject.BUTTONS,
        "buttons",
        9,
        0.0,
        4,
        sought=("up", "left"),
        needs_all=True,
        pressed=(up, left),
    )
    assert describe_awaited(awaited) == "up and left were not pressed at the same time"
    assert "shift with ↑ and ← holds up and left" in describe_wait_with_keys([awaited], SPEC)


def test_a_live_run_that_waits_for_a_connection_is_not_advised_speed_1() -> None:
    awaited = Awaited(Subject.CONNECTION, "socket", 3, 0.5, 7)
    assert "--speed 1" in name_remedy(awaited, SPEC)
    assert "--speed" not in name_remedy(awaited, SPEC, is_live=True)


@pytest.mark.parametrize(("color", "x_mm"), COLOR_PLACES_MM.items())
def test_the_coloured_mat_has_each_colour_there(color: str, x_mm: int) -> None:
    spec = replace(SPEC, world=WorldSpec(background=COLORED_MAT))
    field = field_files(spec).open_field()
    pose = replace(background(COLORED_MAT).start, x_mm=float(x_mm))
    for sensor in spec.robot.color_sensors:
        assert measure_color(sensor, Instant(0, pose), field).name.lower() == color
