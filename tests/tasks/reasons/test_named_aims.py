"""What programs say that they mean, and what their runs did."""

from __future__ import annotations

from tests.cases import cases
from tests.tasks.reasons.runs import run_text
from tuisim.tasks.reasons.reason import ReasonKind, find_reasons

BANDS = "# %%sim_magic_preloaded -b Grey_bands\nimport time\n"
LIGHT = "colorLeft.reflected_light_intensity_pc"
UNTIL = f"{BANDS}tank_drive.on(50, 50)\nwhile {LIGHT} > {{}}:\n    pass\n"
BASE = """\
# %%sim_magic -b Empty_Map -x 400 -y 500
from pybricks.ev3devices import Motor
from pybricks.parameters import Port
from pybricks.robotics import DriveBase
base = DriveBase(Motor(Port.B), Motor(Port.C), 56, 180)
"""
MISSED = {
    "another band": (
        UNTIL.format(90) + "tank_drive.off()\nprint('I am on black')\n",
        "line 4: light of 89.02 % ended this loop, since it is 90 % or less, but it is not black: that reads 0 % "
        "and comes 1204 mm further on",
    ),
    "wheels against each other": (
        f"{BANDS}# straight on\ntank_drive.on_for_seconds(30, -30, 1)\n",
        "line 4: the robot turned on the spot here, by 80°",
    ),
    "two speeds for a steering": (
        f"{BANDS}# straight on for 3 rotations\ntank_turn.on_for_rotations(30, 30, 3)\n",
        "line 4: the robot turned by 101° here: a MoveSteering takes the steering first, and 0 drives",
    ),
    "a steering for two speeds": (
        f"{BANDS}tank_drive.on_for_rotations(0, 30, 1)  # forward\n",
        "here: a MoveTank takes a speed for each wheel, and equal ones drive straight on",
    ),
    "the function turns to the other side": (
        f"{BANDS}def turn_left():\n    tank_drive.on_for_degrees(30, -30, 289)\n\nturn_left()\n",
        "line 3: turn_left says left, but the robot turned right here, by 90°: swap the signs",
    ),
    "a comment says the other side": (
        f"{BANDS}# turn left by 90 degrees\ntank_turn.on_for_degrees(100, 30, 289)\n",
        "line 4: the comment says left, but the robot turned right here, by 90°: swap the signs",
    ),
    "cm for mm": (
        f"{BASE}base.straight(50)  # 50 cm\n",
        "line 6: straight(50) drives 50 mm: straight(500) drives 50 cm",
    ),
    "ms for s": (
        f"{BANDS}tank_drive.on(5, 5)\ntime.sleep(1000)\n",
        "line 4: sleep(1000) waits 1000 s, not ms: sleep(1) waits 1000 ms",
    ),
    "a move of milliseconds": (
        f"{BANDS}tank_drive.on_for_seconds(5, 5, 2000)\n",
        "line 3: on_for_seconds counts seconds, so this takes 33 minutes: 2 s are 2000 ms",
    ),
}


@cases("text, words", MISSED)
def test_what_a_run_did_otherwise_than_its_words_say_is_told(text: str, words: str) -> None:
    first = find_reasons(run_text(text, limit_s=5.0))[0]
    assert first.kind is ReasonKind.MISTAKEN
    assert words in first.words


@cases(
    "text",
    {
        "black": UNTIL.format(10) + "tank_drive.off()\nprint('I am on black')\n",
        "the first grey": UNTIL.format(90) + "tank_drive.off()\nprint('grey, not black')\n",
        "the edge of the black": UNTIL.format(50).replace("Grey_bands", "Grey_bands -x 1400")
        + "tank_drive.off()\nprint('I am on black')\n",
        "a long move": f"{BANDS}tank_drive.on_for_seconds(5, 5, 120)\n",
        "a long pause": f"{BANDS}tank_drive.on_for_seconds(5, 5, 1)\ntime.sleep(1000)\n",
        "a curve": f"{BANDS}# forward in a curve\ntank_turn.on_for_rotations(30, 30, 3)\n",
        "to the left": f"{BANDS}# straight to the left\ntank_turn.on_for_rotations(30, 30, 3)\n",
        "no comment": f"{BANDS}tank_turn.on_for_rotations(30, 30, 3)\n",
        "a correction": f"{BANDS}# straight on\ntank_turn.on_for_rotations(2, 30, 3)\n",
        "a turn": f"{BANDS}# turn right\ntank_drive.on_for_seconds(30, -30, 1)\n",
        "a right angle": f"{BANDS}# turn by a right angle\ntank_turn.on_for_degrees(-100, 30, 289)\n",
        "a turn back": f"{BANDS}def turn_left(deg):\n    tank_turn.on_for_degrees(-100, 30, deg)\n\nturn_left(-289)\n",
        "another number": f"{BASE}base.straight(500)  # 50 cm\n",
    },
)
def test_a_run_that_did_as_it_says_has_no_reason(text: str) -> None:
    assert find_reasons(run_text(text, limit_s=12.0)) == ()
