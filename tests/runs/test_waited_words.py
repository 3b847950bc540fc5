"""What a run waited for, in words: of real programs, as they are run."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from tests.cases import cases
from tests.conftest import Command
from tuisim.core.profile import PROFILES
from tuisim.core.spec import RobotSpec, RunSpec, WorldSpec
from tuisim.runs.waited import Awaited, Subject
from tuisim.runs.waited_words import describe_awaited, describe_wait_with_keys, name_remedy

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

PROGRAMS = {
    "button": (
        WAIT_BUTTON,
        "read the brick's buttons N times, none was pressed: --press enter@1, or K in the app",
    ),
    "touch": (WAIT_TOUCH, "touch sensor on in1 was never pressed: --press in1@2"),
    "remote": (
        REMOTE,
        "infrared sensor on in1: no button of the remote was pressed: --press remote.left_up@1-3",
    ),
    "line": (
        FOLLOW,
        "colour sensor on in2 saw only white: -b Loop gives it a line (tuisim backgrounds)",
    ),
    "socket": (
        ACCEPT,
        "socket.accept in line 6: nobody connected: --speed 1 gives the other program the time to come",
    ),
    "on purpose": (PLAY, ""),
}


@cases("text, sentence", PROGRAMS)
def test_the_last_line_and_json_say_what_was_waited_for(
    tmp_path: Path, here: Command, text: str, sentence: str
) -> None:
    (tmp_path / "prog.py").write_text(text)
    done = here("run", "prog.py", "--timeout", 6)
    assert done.returncode == 3
    last = _TIMES.sub("N times", done.stderr)
    assert (f" · {sentence} · 0 samples" if sentence else "° · 0 samples") in last
    done = here("run", "prog.py", "--timeout", 6, "--json")
    assert _TIMES.sub("N times", json.loads(done.stdout)["waited_for"]) == sentence


@pytest.mark.parametrize(
    ("text", "press"),
    [
        (WAIT_BUTTON, "enter@1"),
        (WAIT_TOUCH, "in1@2-2.5"),
        (WAIT_TOUCH, "touch@2"),
    ],
)
def test_what_the_sentence_advises_ends_the_wait(
    tmp_path: Path, here: Command, text: str, press: str
) -> None:
    (tmp_path / "prog.py").write_text(text)
    done = here("run", "prog.py", "--press", press, "--json")
    facts = json.loads(done.stdout)
    assert (facts["state"], facts["waited_for"]) == ("finished", "")
    assert facts["x_mm"] == pytest.approx(1181 + 352, abs=8)


def test_the_remote_drives_while_it_is_pressed(tmp_path: Path, here: Command) -> None:
    (tmp_path / "prog.py").write_text(REMOTE)
    done = here("run", "prog.py", "--press", "remote.left_up@1-3", "--timeout", 9, "--json")
    facts = json.loads(done.stdout)
    assert 1181 + 250 < facts["x_mm"] < 1181 + 400
    assert facts["waited_for"] == ""


def test_a_batch_says_it_in_a_column(tmp_path: Path, here: Command) -> None:
    (tmp_path / "prog.py").write_text(WAIT_TOUCH)
    here("batch", "prog.py", "--seeds", "0..1", "--timeout", 6, "--out", "rows.csv")
    header, first, _ = (tmp_path / "rows.csv").read_text().splitlines()
    assert "waited_for" in header.split(",")
    assert "touch sensor on in1 was never pressed: --press in1@2" in first


@pytest.mark.parametrize("subject", Subject)
def test_there_are_words_for_everything(subject: Subject) -> None:
    awaited = Awaited(subject, "in4", 3, 0.5, 7, "12 cm")
    assert describe_awaited(awaited) and name_remedy(awaited, SPEC)
    assert describe_wait_with_keys([awaited], SPEC).startswith(describe_awaited(awaited))


def test_without_walls_they_are_advised() -> None:
    open_floor = RunSpec(RobotSpec(), WorldSpec(walls=False), PROFILES["ev3"])
    awaited = Awaited(Subject.DISTANCE, "in4", 3, 0.5, 7, "255 cm")
    assert name_remedy(awaited, open_floor).startswith("--walls on, or -o ")
    assert "--walls" not in name_remedy(awaited, SPEC)
