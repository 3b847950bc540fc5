"""The version of Pybricks that a program is for."""

from tests.cases import for_each
from tuisim.base.source import Program
from tuisim.programs.robot.pybricks_version import find_version_4_name
from tuisim.programs.robot.source import read_modules

OF_4 = {
    "from pybricks.tools import multitask, run_task, wait": "multitask",
    "from pybricks.tools import *\nrun_task(main())": "run_task",
    "from pybricks import tools\ntools.run_task(main())": "run_task",
    "from pybricks import version": "version",
    "from pybricks.parameters import Axis, Port": "Axis",
    "from pybricks.hubs import ThisHub": "ThisHub",
    "motor.run_angle(500, 90, Stop.NONE)": "Stop.NONE",
    "parameters.Stop.COAST_SMART": "Stop.COAST_SMART",
    "eye.color() == Color.NONE": "Color.NONE",
    "SKIN = Color(20, 60, 90)": "Color(h, s, v)",
    "robot.straight(200, then=Stop.COAST)": "then= of straight()",
    "robot.turn(90, Stop.HOLD, False)": "then of turn()",
    "robot.turn(90, absolute=True)": "absolute= of turn()",
    "robot.arc(100, angle=90)": "arc()",
    "self.base.curve(100, 90)": "curve()",
    "Motor(Port.A, reset_angle=False)": "reset_angle= of Motor()",
    "hub.light.blink(Color.RED, [100, 100])": "light.blink",
    "ev3.speaker.volume(50)": "speaker.volume",
    "hub.system.set_stop_button(None)": "system.set_stop_button",
}


@for_each(text=OF_4)
def test_a_name_that_only_pybricks_4_has_is_found(text: str) -> None:
    assert find_version_4_name(read_modules(Program("p.py", text)).values()) == OF_4[text]


@for_each(
    text=[
        "from pybricks.tools import DataLog, StopWatch, print, wait",
        "from pybricks.parameters import Align, Button, Color, Direction, ImageFile, Port, Stop",
        "motor.run_angle(500, 90, then=Stop.COAST, wait=False)",
        "robot.straight(200)\nrobot.turn(-90)\nrobot.drive(100, 0)\nrobot.stop(Stop.BRAKE)",
        "ev3.light.on(Color.RED)\nev3.speaker.beep()",
        "os.system('ls')",
        "def turn(angle, wait=True):\n    pass\nturn(90, wait=False)",
        "class Robot:\n    def arc(self, radius):\n        pass\nRobot().arc(5)",
        "async def run_task():\n    pass\nrun_task()",
        "class Color:\n    NONE = 0\nColor.NONE",
    ]
)
def test_names_that_pybricks_2_has_are_not_taken_for_version_4(text: str) -> None:
    assert find_version_4_name(read_modules(Program("p.py", text)).values()) == ""
