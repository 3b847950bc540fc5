"""What the expressions of a program can be: ports in every way in which people write them."""

from __future__ import annotations

from collections.abc import Mapping

from tests.cases import for_each
from tests.programs.robot.reading import changed

PORTS: Mapping[str, tuple[str, str]] = {
    "concatenated": ("MediumMotor('out' + 'A')", "A medium motor"),
    "percent": ("TouchSensor('in%d' % 4)", "4 touch"),
    "a row of three": ("[ColorSensor(p) for p in (INPUT_1, INPUT_2, INPUT_3)]", "1 left, 2 middle"),
    "sides that are swapped": (
        "cs_left, cs_right, cs_block = ColorSensor('in1'), ColorSensor('in2'), ColorSensor('in3')",
        "1 left, 2 right, 3 middle",
    ),
    "by keyword": ("MediumMotor(address=OUTPUT_A)", "A medium motor"),
    "conditional": (
        "import sys\nMediumMotor(OUTPUT_A if len(sys.argv) > 5 else OUTPUT_A)",
        "A medium motor",
    ),
    "or": ("port = None\nMediumMotor(port or OUTPUT_D)", "D medium motor"),
    "walrus": ("MediumMotor(p := OUTPUT_A)", "A medium motor"),
    "unpacked": ("a, b = OUTPUT_A, OUTPUT_D\nMediumMotor(b)", "D medium motor"),
    "list item": ("ports = [OUTPUT_A, OUTPUT_D]\nMediumMotor(ports[-1])", "D medium motor"),
    "dict.get": ("ports = {'x': OUTPUT_D}\nMediumMotor(ports.get('x'))", "D medium motor"),
    "default argument": (
        "def make(port=OUTPUT_D):\n    MediumMotor(port)\nmake()",
        "D medium motor",
    ),
    "other than the default": (
        "def make(port=OUTPUT_D):\n    MediumMotor(port)\nmake(OUTPUT_A)",
        "A medium motor",
    ),
    "made in a default argument": (
        "def go(speed, *, angle, motor=MediumMotor(OUTPUT_D)):\n    motor.on(speed)\ngo(5, angle=1)",
        "D medium motor",
    ),
    "returned": ("def port():\n    return OUTPUT_D\nMediumMotor(port())", "D medium motor"),
    "class attribute": (
        "class C:\n    ARM = OUTPUT_D\n    def go(self):\n        MediumMotor(self.ARM)\nC().go()",
        "D medium motor",
    ),
    "attribute of a base": (
        "class B:\n    ARM = OUTPUT_D\nclass C(B):\n    def __init__(self):\n"
        "        MediumMotor(self.ARM)\nC()",
        "D medium motor",
    ),
    "global": (
        "ARM = None\ndef setup():\n    global ARM\n    ARM = OUTPUT_D\nsetup()\nMediumMotor(ARM)",
        "D medium motor",
    ),
    "a class that is given": (
        "def make(kind, port):\n    return kind(port)\nmake(MediumMotor, OUTPUT_D)",
        "D medium motor",
    ),
    "no port at all": ("MediumMotor()", "A medium motor"),
    "a port that is not known": (
        "import json\ncfg = json.load(open('x'))\nMediumMotor(cfg['arm'])",
        "A medium motor",
    ),
    "two that are not known": (
        "p = input()\nMediumMotor(p)\nMediumMotor(input())",
        "A medium motor, D medium motor",
    ),
    "never called": ("def unused():\n    MediumMotor(OUTPUT_A)", ""),
    "in a class that is not used": (
        "class C:\n    def __init__(self):\n        MediumMotor(OUTPUT_A)",
        "",
    ),
    "in a thread": (
        "import threading\nclass T(threading.Thread):\n    def run(self):\n        MediumMotor(OUTPUT_A)\n"
        "T().start()",
        "A medium motor",
    ),
    "only imported": ("", ""),
    "a mux": ("TouchSensor('in1:i2c80:mux1')", ""),
    "a driver that is not simulated": ("Sensor(INPUT_1, driver_name='ht-nxt-compass')", ""),
    "a sensor whose mode is set": (
        "some = Sensor(INPUT_2)\nsome.mode = 'GYRO-ANG'",
        "2 gyro, 4 left",
    ),
    "two kinds on one port": (
        "ColorSensor('in1')\nTouchSensor('in1')\nTouchSensor('in1')",
        "1 touch",
    ),
    "two gyros": ("GyroSensor('in1')\nGyroSensor('in4')", ""),
    "four colours": (
        "[ColorSensor(p) for p in (INPUT_1, INPUT_2, INPUT_3, INPUT_4)]",
        "1 middle, 4 front",
    ),
    "four touches": (
        "[TouchSensor(p) for p in (INPUT_1, INPUT_2, INPUT_3, INPUT_4)]",
        "1 touch, 2 touch_right, 3 touch_back, 4 touch_front",
    ),
    "sensors that fill all ports": (
        "TouchSensor('in1')\nTouchSensor('in2')\nTouchSensor('in3')\nTouchSensor('in4')\nGyroSensor()",
        "1 touch, 2 touch_right, 3 touch_back, 4 touch_front",
    ),
    "refers to itself": ("a = b\nb = a\nMediumMotor(a)\nclass C(C): pass\nC()", "A medium motor"),
    "recursion": (
        "def f(p, n):\n    return f(p, n - 1) if n else MediumMotor(p)\nf(OUTPUT_D, 3)",
        "D medium motor",
    ),
}


@for_each(case=PORTS)
def test_ports_are_found_however_they_are_written(case: str) -> None:
    text, expected = PORTS[case]
    assert changed(text) == expected
