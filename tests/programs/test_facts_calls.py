"""Which calls a program has, whatever it calls them."""

from __future__ import annotations

from tests.cases import for_rows
from tuisim.base.source import Program
from tuisim.programs.facts import read_facts

CALLS = {
    "as it is": ("import time\ntime.sleep(1)\n", "time.sleep", [2]),
    "several lines": ("import time\ntime.sleep(1)\n\ntime.sleep(2)\n", "time.sleep", [2, 4]),
    "module under another name": ("import time as t\nt.sleep(1)\n", "time.sleep", [2]),
    "function imported": ("from time import sleep\nsleep(1)\n", "time.sleep", [2]),
    "function under another name": ("from time import sleep as nap\nnap(1)\n", "time.sleep", [2]),
    "everything imported": ("from time import *\nsleep(1)\n", "time.sleep", [2]),
    "assigned": ("import time\nwait = time.sleep\nwait(1)\n", "time.sleep", [3]),
    "assigned twice": ("import time\na = time\nb = a.sleep\nb(1)\n", "time.sleep", [4]),
    "not called": ("import time\nwait = time.sleep\n", "time.sleep", []),
    "another module": ("import other\nother.sleep(1)\n", "time.sleep", []),
    "in a comment": ("# time.sleep(1)\nprint('time.sleep(1)')\n", "time.sleep", []),
    "in a function": ("import time\ndef f():\n    time.sleep(1)\n", "time.sleep", [3]),
    "preloaded": ("tank_drive.on(5, 5)\n", "tank_drive.on", [1]),
    "preloaded, another method": ("tank_drive.off()\n", "tank_drive.on", []),
    "preloaded, another object": ("tank_turn.on(5, 5)\n", "tank_drive.on", []),
    "preloaded, under another name": ("t = tank_drive\nt.on(5, 5)\n", "tank_drive.on", [2]),
    "own object": (
        "from ev3dev2.motor import MoveTank\nt = MoveTank('outB', 'outC')\nt.on(5, 5)\n",
        "tank_drive.on",
        [3],
    ),
    "own object, everything": (
        "from ev3dev2.motor import *\nt = MoveTank('outB', 'outC')\nt.on(1, 1)\n",
        "MoveTank.on",
        [3],
    ),
    "attribute": (
        "import ev3dev2.motor\nclass A:\n    def f(self):\n        self.t = ev3dev2.motor.MoveTank(1, 2)\n"
        "        self.t.on(1, 1)\n",
        "tank_drive.on",
        [5],
    ),
    "object made and used": ("MoveTank(OUTPUT_B, OUTPUT_C).on(1, 1)\n", "tank_drive.on", [1]),
    "a class of Pybricks": (
        "from pybricks.robotics import DriveBase\nrobot = DriveBase(l, r, 56, 114)\nrobot.straight(100)\n",
        "DriveBase.straight",
        [3],
    ),
    "a class of Pybricks, by its module": (
        "from pybricks.robotics import DriveBase as Base\nrobot = Base(l, r, 56, 114)\nrobot.straight(100)\n",
        "pybricks.robotics.DriveBase.straight",
        [3],
    ),
    "a part of Pybricks' brick": (
        "from pybricks.hubs import EV3Brick\nev3 = EV3Brick()\nev3.speaker.beep()\nwait(1)\n",
        "EV3Brick.speaker.beep",
        [3],
    ),
    "a class of Pybricks, imported in a function": (
        "def go():\n    from pybricks.robotics import DriveBase\n    DriveBase(l, r, 56, 114).straight(100)\n",
        "DriveBase.straight",
        [3],
    ),
    "a name of another function": (
        "from ev3dev2.motor import MoveTank\ndef f():\n    t = MoveTank('outB', 'outC')\ndef g(t):\n    t.on(1, 1)\n",
        "tank_drive.on",
        [],
    ),
    "a class of that name of its own": (
        "from mine import DriveBase\nDriveBase().straight(100)\n",
        "pybricks.robotics.DriveBase.straight",
        [],
    ),
    "method alone": ("tank_drive.on_for_rotations(1, 1, 1)\n", "on_for_rotations", [1]),
    "function alone": ("print(input())\n", "input()", [1]),
    "function alone under another name": ("from time import sleep as nap\nnap(1)\n", "sleep", [2]),
}


@for_rows("text, call, lines", CALLS)
def test_calls_are_found_under_any_name(text: str, call: str, lines: list[int]) -> None:
    assert read_facts(Program("p.py", text, "preloaded")).find_calls(call) == lines
