"""What a program waited for in vain in its last loop or move, and what it just missed."""

from __future__ import annotations

import pytest

from tests.cases import cases
from tests.tasks.reasons.runs import run_text
from tuisim.tasks.reasons import unmet
from tuisim.tasks.reasons.run_data import RunData
from tuisim.tasks.reasons.unmet import (
    find_early_end,
    find_first,
    find_unmet,
    list_near_misses,
    list_stale_angles,
)


def load(text: str) -> RunData:
    return RunData(run_text(text))


BANDS = "# %%sim_magic_preloaded -b Grey_bands\n"
DRIVES = f"{BANDS}tank_drive.on(SpeedPercent(40), SpeedPercent(40))\n"
TURNS = f"{BANDS}tank_drive.on(SpeedPercent(-20), SpeedPercent(20))\n"
LIGHT = "colorLeft.reflected_light_intensity_pc"
VAIN = {
    "the other way": (
        f"{TURNS}while gyro.angle < 90:\n    pass\n",
        "gyro on in4 to read 90° or more: it went from 0 to -",
    ),
    "too far": (
        f"{TURNS}while gyro.angle > -90000:\n    pass\n",
        "gyro on in4 to read -90000° or less: it went from 0",
    ),
    "equality": (
        f"{DRIVES}while {LIGHT} != 50:\n    pass\n",
        "colorLeft on in2 to read exactly 50 %: 50.2 at 4.53 s came nearest; "
        "it passed without being equal: ask with < or >",
    ),
    "at rest": (
        f"{BANDS}while {LIGHT} > 50:\n    pass\n",
        "colorLeft on in2 to read 50 % or less: it stayed at 100",
    ),
    "a colour": (
        f"{DRIVES}while colorLeft.color_name != 'Red':\n    print(1)\n",
        "colorLeft on in2 to see 'Red': it saw only 'Black', 'White'",
    ),
    "a name in small letters": (
        f"{DRIVES}while colorLeft.color_name != 'white2':\n    print(1)\n",
        "colorLeft on in2 to see 'white2': it saw only 'Black', 'White'",
    ),
    "a text for a number": (
        f"{DRIVES}while colorLeft.color != 'White':\n    print(1)\n",
        "colorLeft on in2 to see 'White': it saw only 1, 6; "
        "color is a number (6 for 'White'), color_name is the word",
    ),
    "read once": (
        f"{DRIVES}from time import sleep\nv = {LIGHT}\nwhile v > 20:\n    sleep(1)\n",
        "v to be 20 or less, but nothing changes it after line 4: read it inside the loop",
    ),
    "a count that nobody counts": (
        f"{BANDS}def go():\n    tank_drive.on_for_seconds(9, 9, 0.5)\nsides = 0\n"
        "while sides < 4:\n    go()\n",
        "sides to be 4 or more, but nothing changes it after line 4: count sides in the loop",
    ),
    "a change the other way": (
        f"{BANDS}start = gyro.angle\ntank_drive.on(-20, 20)\nwhile gyro.angle - start < 90:\n    pass\n",
        "gyro on in4 to change by 90° or more: it went from 0 to -",
    ),
    "an aim the other way": (
        f"{BANDS}aim = gyro.angle + 90\ntank_drive.on(-20, 20)\nwhile gyro.angle < aim:\n    pass\n",
        "gyro on in4 to change by 90° or more: it went from 0 to -",
    ),
    "rotations for degrees": (
        f"{BANDS}tank_drive.on_for_rotations(20, 20, 360)\n",
        "360 rotations of the wheels: they had turned 4",
    ),
}


@cases("text, words", VAIN)
def test_a_wait_in_vain_is_named_with_the_values_that_came_instead(text: str, words: str) -> None:
    wait = find_unmet(load(text))
    assert wait is not None
    assert wait.text.startswith(words)
    assert wait.time_s < 0.1
    assert wait.line == text.count("\n", 0, max(text.find("while"), len(BANDS))) + 1


RIGHT = {
    "it comes": f"{DRIVES}while {LIGHT} > 55:\n    pass\ntank_drive.off()\n",
    "it came": f"{DRIVES}while {LIGHT} > 55:\n    pass\nwhile True:\n    print({LIGHT})\n",
    "again and again": f"{TURNS}while True:\n    gyro.reset()\n    while gyro.angle > -90:\n        pass\n",
    "for ever": f"{DRIVES}while True:\n    print({LIGHT})\n",
    "for ever at the end": f"{DRIVES}while True:\n    pass\n",
    "a change": f"{DRIVES}aim = 60 + {LIGHT}\nwhile {LIGHT} - aim > -100:\n    pass\n",
    "for ever by a flag": f"{BANDS}run = 1\nwhile run == 1:\n    tank_drive.on_for_seconds(9, 9, 1)\n",
}


@cases("text", RIGHT)
def test_no_wait_in_vain_is_found_in_a_program_that_works(text: str) -> None:
    run = load(text)
    assert find_unmet(run) is None
    assert find_first(list_near_misses, run) is None


def test_a_reading_that_just_misses_the_level_waited_for_is_named() -> None:
    text = f"{DRIVES}while {LIGHT} > 50:\n    pass\ntank_drive.off()\n"
    miss = find_first(list_near_misses, load(text))
    assert miss is not None
    assert miss.text == "50.2 just missed the 50 or less that it waited for"
    assert miss.time_s == pytest.approx(4.53, abs=0.05)


SQUARE = """\
# %%sim_magic_preloaded -b Empty_Map -x 800 -y 500
for side in range(3):
    tank_drive.on_for_rotations(SpeedPercent(40), SpeedPercent(40), 0.5)
    tank_drive.on(SpeedPercent(30), SpeedPercent(-30))
    while gyro.angle < 90:
        pass
    tank_drive.off()
"""


def test_a_turn_to_a_class_constant_gives_no_reason_and_no_error() -> None:
    text = "class Turn:\n    ANGLE = 90\n" + SQUARE.replace("< 90", "< Turn.ANGLE")
    assert find_first(list_stale_angles, load(text)) is None


def test_a_turn_that_ends_at_once_names_the_gyro_that_nobody_reset() -> None:
    stale = find_first(list_stale_angles, load(SQUARE))
    assert stale is not None and stale.line == 5
    assert stale.text.startswith("gyro on in4 was at 90° already when the loop began again")
    assert (
        find_first(
            list_stale_angles,
            load(SQUARE.replace("    tank_drive.off", "    gyro.reset()\n    tank_drive.off")),
        )
        is None
    )


CENTIMETRES = """\
# %sim_magic -b Empty_Map --obstacles Wall -x 400 -y 600 -a 0
from pybricks.ev3devices import Motor, UltrasonicSensor
from pybricks.parameters import Port
from pybricks.robotics import DriveBase
robot = DriveBase(Motor(Port.B), Motor(Port.C), 56, 180)
eyes = UltrasonicSensor(Port.S1)
# Stop 15 cm before the wall.
robot.drive(150, 0)
while eyes.distance() > 15:
    pass
"""
OLD_LIBRARY = """\
from ev3dev.ev3 import *
LIMIT = 3
eye = ColorSensor()
eye.mode = "COL-REFLECT"
while eye.value() > LIMIT:
    time.sleep(0.1)
"""


TURNS_OF_A_WHEEL = """\
from ev3dev2.motor import *
wheel = LargeMotor(OUTPUT_B)
wheel.on(20)
while wheel.rotations < 360:
    pass
"""


GREYS = """\
# %%sim_magic -b Grey_bands -x 150 -y 500
from pybricks.ev3devices import ColorSensor, Motor
from pybricks.parameters import Color, Port
from pybricks.robotics import DriveBase
eye = ColorSensor(Port.S3)
DriveBase(Motor(Port.B), Motor(Port.C), 56, 114).drive(300, 0)
while eye.color() != Color.RED:
    pass
"""


HEADING = """\
# %%sim_magic -b Empty_Map
from pybricks.hubs import PrimeHub
from pybricks.parameters import Direction, Port
from pybricks.pupdevices import Motor
Motor(Port.A, Direction.COUNTERCLOCKWISE).run(-200)
Motor(Port.B).run(200)
while PrimeHub().imu.heading() < 90:
    pass
"""


REVERSED = """\
# %%sim_magic -b Empty_Map
from pybricks.hubs import PrimeHub
from pybricks.parameters import Direction, Port
from pybricks.pupdevices import Motor
left = Motor(Port.A, Direction.COUNTERCLOCKWISE)
left.run(-100)
Motor(Port.B).run(-100)
while left.angle() > -9999:
    pass
"""


@cases(
    "text, words",
    {
        "a reversed motor": (
            REVERSED,
            "the motor on A to read -9999° or less: it went from -0.1 to -",
        ),
        "no colour": (
            GREYS,
            "eye on in3 to see red: it saw only black, blue, no colour, white",
        ),
        "a text for a colour": (
            GREYS.replace("Color.RED", "'red'"),
            "eye on in3 to see 'red': it saw only Color.BLACK, Color.BLUE, "
            "Color.NONE, Color.WHITE; a text equals no colour, Color.RED does",
        ),
        "the gyro of a hub": (
            HEADING,
            "the gyro in the hub to read 90° or more: it went from 0 to -",
        ),
        "a value": (OLD_LIBRARY, "the colour sensor on in2 to read 3 or less: it stayed at 85"),
        "a comment in cm": (
            CENTIMETRES,
            "eyes on in1 to read 15 mm or less: 31 at 7.04 s came nearest; 15 cm are 150 mm",
        ),
        "turns": (
            TURNS_OF_A_WHEEL,
            "the motor on outB to read 360 rotations or more: it went from 0 to ",
        ),
    },
)
def test_waits_in_vain_of_programs_in_other_libraries_are_found(text: str, words: str) -> None:
    wait = find_unmet(load(text))
    assert wait is not None
    assert wait.text.startswith(words)


EARLY = {
    "never called": (
        f"{BANDS}def go():\n    tank_drive.on(20, 20)\nprint(go)\n",
        "this line would drive the robot, but it never ran: nothing called the function of line 2",
    ),
    "a condition that was false": (
        f"{BANDS}if __name__ == 'main':\n    tank_drive.on_for_degrees(20, 20, 400)\n",
        "this line would drive the robot, but it never ran",
    ),
    "no wait": (
        f"{DRIVES}tank_drive.off()\n",
        "the program ended when the motors that this line starts had",
    ),
    "a small turn": (
        f"{BANDS}tank_drive.on_for_degrees(30, 30, 1)\n",
        "when the motors that this line starts had moved the robot by only 0.5 mm",
    ),
    "a text that is no number": (
        f"{DRIVES}while colorLeft.color == 'White':\n    pass\ntank_drive.off()\n",
        "the loop ended at once: colorLeft on in2 read 6, not 'White'",
    ),
    "another colour": (
        f"{DRIVES}while colorLeft.color == ColorSensor.COLOR_RED:\n    pass\n",
        "colorLeft on in2 read white, not red",
    ),
    "a true limit": (
        f"{DRIVES}while {LIGHT} < 20:\n    pass\ntank_drive.off()\n",
        "the loop ended at once: colorLeft on in2 read 100 %, already 20 % or more; "
        "turn its sign round to wait for less than 20 %",
    ),
    "a distance in mm": (
        "# %%sim_magic_preloaded -b Empty_Map -o Wall\ntank_drive.on(30, 30)\n"
        "while ultrasonic.distance_centimeters > 200:\n    pass\ntank_drive.off()\n",
        "ultrasonic on in1 read 138 cm, already 200 cm or less; 200 mm are 20 cm",
    ),
}


@cases("text, words", EARLY)
def test_the_reason_why_a_program_ended_at_once_is_told(text: str, words: str) -> None:
    early = find_early_end(load(text))
    assert early is not None
    assert words in early.text


@pytest.mark.parametrize(
    "text",
    [
        f"{BANDS}print({LIGHT})\n",
        f"{DRIVES}while {LIGHT} > 55:\n    pass\ntank_drive.off()\n",
        f"{DRIVES}print(x)\n",
        f"{BANDS}tank_drive.on_for_degrees(80, 80, 60)\n",
        "from ev3dev2.motor import MediumMotor\nMediumMotor('outA').on_for_degrees(50, 60)\n",
    ],
)
def test_a_program_that_drove_far_enough_is_not_said_to_end_early(text: str) -> None:
    assert find_early_end(load(text)) is None


def test_a_short_wait_is_not_reported_as_in_vain(monkeypatch: pytest.MonkeyPatch) -> None:
    run = load(VAIN["at rest"][0])
    monkeypatch.setattr(unmet, "_MIN_STAY_S", 31.0)
    assert find_unmet(run) is None


def test_no_wait_in_vain_is_reported_for_light_with_noise() -> None:
    assert find_unmet(load(VAIN["equality"][0].replace("bands", "bands -N 5"))) is None
