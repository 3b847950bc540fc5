"""Starts and stops of motors that have no effect."""

from __future__ import annotations

from tests.cases import cases, for_rows
from tuisim.base.source import Program
from tuisim.programs.facts import read_facts
from tuisim.programs.idle_moves import list_stopping_loops

MAKES = """\
tank = MoveTank(OUTPUT_B, OUTPUT_C)
steer = MoveSteering(OUTPUT_B, OUTPUT_C)
arm = MediumMotor(OUTPUT_A)
robot = DriveBase(left, right, 56, 114)
"""


def list_texts(text: str) -> list[str]:
    return [words for _, words in read_facts(Program("p.py", MAKES + text)).slips]


@cases(
    "text, words",
    {
        "a drive": (
            "robot.drive(500, 0)\nrobot.stop()\n",
            "line 6 stops at once what this line starts: robot.straight(500) drives 500 mm",
        ),
        "a curve": (
            "robot.drive(500, 30)\nrobot.stop()\n",
            "line 6 stops at once what this line starts: wait in between lets them run",
        ),
        "with a print between": (
            "tank.on(20, 20)\nprint('go')\ntank.off()\n",
            "line 7 stops at once what this line starts: sleep in between lets them run, "
            "or on_for_seconds in its place",
        ),
        "if for elif": (
            "if us < 5:\n    steer.on(-60, 15)\nif us > 9:\n    steer.on(60, 15)\n"
            "else:\n    tank.on(15, 15)\n",
            "line 7 and on overrule at once what this line starts: write elif in line 7",
        ),
        "a break of one loop": (
            "while True:\n    tank.on(20, 20)\n    while True:\n        if us < 5:\n"
            "            tank.off()\n            break\n",
            "this break ends only the loop of line 7, and line 6 starts the motors again: "
            "the outer loop needs its own",
        ),
    },
)
def test_a_move_without_effect_is_told(text: str, words: str) -> None:
    assert list_texts(text) == [words]


@for_rows(
    "text",
    {
        "a wait between": "tank.on(20, 20)\nsleep(1)\ntank.off()\n",
        "a print that waits": "tank.on(20, 20)\nprint(arm.wait_until('stalled'))\ntank.off()\n",
        "a loop between": "tank.on(20, 20)\nwhile us > 5: pass\ntank.off()\n",
        "another motor": "tank.on(20, 20)\narm.off()\n",
        "no speed": "arm.on(0)\narm.off()\n",
        "a way to brake": "arm.on(20)\narm.off(brake=False)\n",
        "no motor": "light.on(50)\nlight.off()\n",
        "elif": (
            "if us < 5:\n    steer.on(-60, 15)\nelif us > 9:\n    steer.on(60, 15)\n"
            "else:\n    tank.on(15, 15)\n"
        ),
        "a wait in the branch": (
            "if us < 5:\n    steer.on(-60, 15)\n    sleep(1)\nif us > 9:\n    steer.on(60, 15)\n"
            "else:\n    tank.on(15, 15)\n"
        ),
        "another motor in a branch": (
            "if us < 5:\n    steer.on(-60, 15)\nif us > 9:\n    arm.on(60)\nelse:\n    tank.on(15, 15)\n"
        ),
        "a condition that waits": (
            "if us < 5:\n    tank.on(9, 9)\nif ask():\n    tank.off()\n    tank.on(5, 5)\n"
            "else:\n    tank.on(15, 15)\n"
        ),
        "no else": "if us < 5:\n    tank.on(9, 9)\nif us > 9:\n    tank.on(5, 5)\n",
        "a patrol": (
            "while True:\n    tank.on(20, 20)\n    while True:\n        if us < 5:\n"
            "            tank.off()\n            break\n    tank.on_for_degrees(20, -20, 289)\n"
        ),
        "another way each time": (
            "while True:\n    robot.drive(90, choose())\n    while True:\n        if us < 5:\n"
            "            robot.stop()\n            break\n"
        ),
        "an end of both loops": (
            "while True:\n    tank.on(20, 20)\n    while True:\n        if us < 5:\n"
            "            tank.off()\n            break\n        if us > 99:\n            exit()\n"
            "    if us < 2:\n        break\n"
        ),
    },
)
def test_a_move_with_an_effect_is_not_blamed(text: str) -> None:
    assert list_texts(text) == []


@for_rows(
    "text, is_told",
    {
        "in the loop": ("tank.on(20, 20)\nwhile us > 5:\n    print(us)\n    tank.off()\n", True),
        "after the loop": ("tank.on(20, 20)\nwhile us > 5:\n    print(us)\ntank.off()\n", False),
        "in a branch": ("tank.on(9, 9)\nwhile us > 5:\n    if x:\n        tank.off()\n", False),
        "with a break": ("tank.on(9, 9)\nwhile us > 5:\n    tank.off()\n    break\n", False),
        "started again": (
            "tank.on(9, 9)\nwhile us > 5:\n    tank.off()\n    steer.on(9, 9)\n",
            False,
        ),
        "by a function": (
            "def go():\n    tank.on(9, 9)\ntank.on(9, 9)\nwhile us > 5:\n    tank.off()\n    go()\n",
            False,
        ),
        "without a start": ("while us > 5:\n    tank.off()\n", False),
        "for ever": ("tank.on(9, 9)\nwhile True:\n    tank.off()\n", False),
    },
)
def test_a_stop_in_the_first_pass_of_a_loop_is_found(text: str, is_told: bool) -> None:
    tree = read_facts(Program("p.py", MAKES + text)).tree
    assert bool([*list_stopping_loops(tree)]) is is_told
