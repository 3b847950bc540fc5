"""Moves that the next command cut off."""

from __future__ import annotations

from tests.cases import cases
from tests.tasks.reasons.runs import run_text
from tuisim.tasks.reasons.reason import find_reasons

BROWSER = "# %%sim_magic_preloaded -b Empty_Map -x 400 -y 500\nimport time\n"
BRICK = """\
# %%sim_magic --profile ev3 -b Empty_Map -x 400 -y 500
import time
from ev3dev2.motor import *
tank = MoveTank(OUTPUT_B, OUTPUT_C)
left, right = tank.left_motor, tank.right_motor
"""
MOTORS = """\
# %%sim_magic --profile ev3 -b Empty_Map -x 400 -y 500
import time
from ev3dev2.motor import *
left = LargeMotor(OUTPUT_B)
right = LargeMotor(OUTPUT_C)
"""
HUB = """\
# %%sim_magic -b Empty_Map -x 400 -y 500
from pybricks.hubs import PrimeHub
from pybricks.parameters import Direction, Port
from pybricks.pupdevices import Motor
from pybricks.robotics import DriveBase
from pybricks.tools import wait
left = Motor(Port.A, Direction.COUNTERCLOCKWISE)
base = DriveBase(left, Motor(Port.B), 56, 114)
"""
TWO_SECONDS = "tank_drive.on_for_seconds(20, 20, 2, block=False)\n"
TURN = "tank.on_for_degrees(20, -20, 200)\n"
CUT = {
    "at once": (
        f"{BROWSER}{TWO_SECONDS}tank_drive.on_for_seconds(20, 0, 1)\n",
        "0.00 s, line 3: block=False did not wait for this move, of which 0.01 of 2 s were done when "
        "line 4 began the next one",
    ),
    "after a pause": (
        f"{BRICK}tank.on_for_rotations(40, 40, 4, block=False)\ntime.sleep(1)\n{TURN}",
        "line 6: block=False did not wait for this move, of which 4",
    ),
    "in functions": (
        f"{BRICK}def go():\n    tank.on_for_rotations(40, 40, 2, block=False)\n"
        "def turn():\n    tank.on_for_degrees(20, -20, 200, block=False)\ngo()\nturn()\n",
        "line 7: block=False did not wait for this move, of which 0 of 720 degrees were done when the next",
    ),
    "by a stop at once": (
        f"{BRICK}tank.on_for_rotations(40, 40, 3, block=False)\ntank.off()\n",
        "line 6: block=False did not wait for this move, of which 0 of 1080 degrees were done when line 7 stopped it",
    ),
    "a drive base": (
        f"{HUB}base.straight(500, wait=False)\nbase.turn(90)\n",
        "line 9: wait=False did not wait for this move, of which 0 of 500 mm were done when line 10 began",
    ),
    "by the end of the program": (
        f"{HUB}base.turn(90)\nbase.straight(500, wait=False)\n",
        "line 10: wait=False did not wait for this move, of which 0 of 500 mm were done when the program",
    ),
}


@cases("text, words", CUT)
def test_a_move_that_was_cut_off_is_named_with_what_was_done(text: str, words: str) -> None:
    (reason,) = find_reasons(run_text(text))
    assert words in reason.words


@cases(
    "text",
    {
        "a pause that is long enough": f"{BROWSER}{TWO_SECONDS}time.sleep(2.1)\n"
        "tank_drive.on_for_seconds(20, 0, 1)\n",
        "a stop": f"{BROWSER}{TWO_SECONDS}time.sleep(1)\ntank_drive.off()\n",
        "a look": f"{BROWSER}{TWO_SECONDS}while ultrasonic.distance_centimeters > 999:\n    pass\n"
        "while get_clock() < 1:\n    print(gyro.angle)\ntank_drive.on_for_seconds(20, 0, 1)\n",
        "two motors at a time": f"{BRICK}for side in range(2):\n"
        "    left.on_for_degrees(20, 200, block=False)\n    right.on_for_degrees(20, 200)\n",
        "a target that moves": f"{BRICK}for angle in range(0, 90, 9):\n"
        "    left.on_to_position(40, angle, block=False)\n    time.sleep(0.05)\n",
        "a brick that finishes it": f"{BRICK}tank.on_for_degrees(20, 20, 200, block=False)\n",
        "a question until it is done": f"{HUB}base.straight(200, wait=False)\n"
        "while not base.done():\n    wait(10)\nbase.turn(90)\n",
    },
)
def test_a_move_that_may_end_so_is_not_blamed(text: str) -> None:
    assert find_reasons(run_text(text)) == ()


WHEELS = HUB.replace("56, 114)", "56, 114)\nright = Motor(Port.B)").replace("base = ", "# ")
LOOP = "for side in range(2):\n    time.sleep(0.2)\n    "
PARTED = {
    "a hub": (
        f"{WHEELS}for side in range(2):\n    wait(9)\n"
        "    left.run_angle(300, 360)\n    right.run_angle(300, 360)\n",
        "line 12: run_angle waits until this wheel is done before line 13 moves the other one: "
        "wait=False on the first drives both",
    ),
    "a brick": (
        f"{MOTORS}{LOOP}left.on_for_degrees(30, 360)\n    right.on_for_degrees(30, 360)\n",
        "line 8: on_for_degrees waits until this wheel is done before line 9 moves the other one: block=False",
    ),
    "a comment": (
        f"{MOTORS}# straight for 2 rotations\nleft.on_for_rotations(30, 1)\nright.on_for_rotations(30, 1)\n",
        "on_for_rotations waits until this wheel is done before line",
    ),
}


@cases("text, words", PARTED)
def test_a_straight_way_that_is_driven_wheel_after_wheel_is_named(text: str, words: str) -> None:
    assert words in " ".join(reason.words for reason in find_reasons(run_text(text)))


@cases(
    "text",
    {
        "a comment on something else": "# test each motor\nleft.on_for_degrees(30, 360)\n"
        "right.on_for_degrees(30, 360)\n",
        "a test of each": "left.on_for_degrees(30, 360)\nright.on_for_degrees(30, 360)\n",
        "together": f"{LOOP}left.on_for_degrees(30, 360, block=False)\n    right.on_for_degrees(30, 360)\n",
        "different angles": f"{LOOP}left.on_for_degrees(30, 360)\n    right.on_for_degrees(30, 180)\n",
        "opposite signs": f"{LOOP}left.on_for_degrees(30, 180)\n    right.on_for_degrees(-30, 180)\n",
        "one wheel": f"{LOOP}left.on_for_degrees(30, 180)\n    left.on_for_degrees(30, 180)\n",
        "a walk": "for _ in range(4):\n"
        "    left.on_for_degrees(30, 180)\n    right.on_for_degrees(30, 180)\n",
        "both with one call elsewhere": "tank = MoveTank(OUTPUT_B, OUTPUT_C)\n"
        f"{LOOP}left.on_for_degrees(30, 180)\n    right.on_for_degrees(30, 180)\n",
        "another motor": "arm = MediumMotor(OUTPUT_A)\n"
        f"{LOOP}left.on_for_degrees(30, 180)\n    arm.on_for_degrees(30, 180)\n",
    },
)
def test_wheels_that_are_moved_one_by_one_on_purpose_are_not_blamed(text: str) -> None:
    assert find_reasons(run_text(MOTORS + text)) == ()
