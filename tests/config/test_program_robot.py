"""What is read of a robot in the source of a program."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path

import pytest

from tuisim.config.program_robot.assembly import BuiltRobot
from tuisim.config.program_settings import facts_of
from tuisim.config.robots import ROBOTS, ports_of
from tuisim.source import Program

USUAL = ROBOTS["Default_Robot"]
HEAD = """\
from ev3dev2.motor import *
from ev3dev2.sensor import *
from ev3dev2.sensor.lego import *
from ev3dev2.wheel import *
"""


def built(text: str, head: str = HEAD) -> BuiltRobot | None:
    return facts_of(Program("p.py", head + text)).robot


def changed(text: str, head: str = HEAD) -> str:
    """The ports that differ from those of the usual robot."""
    found = built(text, head)
    now, usual = dict(ports_of(found.choice.spec if found else USUAL)), dict(ports_of(USUAL))
    ports = [port for port in sorted({*now, *usual}) if now.get(port) != usual.get(port)]
    return ", ".join(f"{port[-1]} {now.get(port, '-')}" for port in ports)


PORTS: Mapping[str, tuple[str, str]] = {
    "concatenated": ("MediumMotor('out' + 'A')", "A medium motor"),
    "formatted": ("n = 4\nTouchSensor(f'in{n}')", "4 touch"),
    "percent": ("TouchSensor('in%d' % 4)", "4 touch"),
    "format": ("MediumMotor('out{}'.format('D'))", "D medium motor"),
    "a row of three": ("[ColorSensor(p) for p in (INPUT_1, INPUT_2, INPUT_3)]", "1 left, 2 middle"),
    "sides that are swapped": (
        "cs_left, cs_right, cs_block = ColorSensor('in1'), ColorSensor('in2'), ColorSensor('in3')",
        "1 left, 2 right, 3 middle",
    ),
    "by keyword": ("MediumMotor(address=OUTPUT_A)", "A medium motor"),
    "conditional": ("import sys\nMediumMotor(OUTPUT_A if len(sys.argv) > 5 else OUTPUT_A)", "A medium motor"),
    "or": ("port = None\nMediumMotor(port or OUTPUT_D)", "D medium motor"),
    "walrus": ("MediumMotor(p := OUTPUT_A)", "A medium motor"),
    "unpacked": ("a, b = OUTPUT_A, OUTPUT_D\nMediumMotor(b)", "D medium motor"),
    "list item": ("ports = [OUTPUT_A, OUTPUT_D]\nMediumMotor(ports[-1])", "D medium motor"),
    "dict.get": ("ports = {'x': OUTPUT_D}\nMediumMotor(ports.get('x'))", "D medium motor"),
    "dict.items": ("for name, port in {'x': OUTPUT_D}.items():\n    MediumMotor(port)", "D medium motor"),
    "dict of keywords": ("ports = dict(x=OUTPUT_D)\nMediumMotor(ports['x'])", "D medium motor"),
    "keywords from a dict": (
        "def make(arm, other=None):\n    MediumMotor(arm)\nPORTS = {'arm': OUTPUT_D}\nmake(**PORTS)",
        "D medium motor",
    ),
    "arguments from a list": ("def make(arm):\n    MediumMotor(arm)\nmake(*[OUTPUT_D])", "D medium motor"),
    "any number of arguments": (
        "def make(*ports):\n    return [MediumMotor(p) for p in ports]\nmake(OUTPUT_A, OUTPUT_D)",
        "A medium motor, D medium motor",
    ),
    "default argument": ("def make(port=OUTPUT_D):\n    MediumMotor(port)\nmake()", "D medium motor"),
    "other than the default": ("def make(port=OUTPUT_D):\n    MediumMotor(port)\nmake(OUTPUT_A)", "A medium motor"),
    "returned": ("def port():\n    return OUTPUT_D\nMediumMotor(port())", "D medium motor"),
    "class attribute": ("class C:\n    ARM = OUTPUT_D\n    def go(self):\n        MediumMotor(self.ARM)\nC().go()",
                        "D medium motor"),
    "attribute of a base": ("class B:\n    ARM = OUTPUT_D\nclass C(B):\n    def __init__(self):\n"
                            "        MediumMotor(self.ARM)\nC()", "D medium motor"),
    "property": ("class C:\n    @property\n    def port(self):\n        return OUTPUT_D\nMediumMotor(C().port)",
                 "D medium motor"),
    "global": ("ARM = None\ndef setup():\n    global ARM\n    ARM = OUTPUT_D\nsetup()\nMediumMotor(ARM)",
               "D medium motor"),
    "class method": ("class C:\n    def __init__(self, port):\n        self.m = MediumMotor(port)\n    @classmethod\n"
                     "    def usual(cls):\n        return cls(OUTPUT_D)\nC.usual()", "D medium motor"),
    "getattr": ("import ev3dev2.motor as m\nMediumMotor(getattr(m, 'OUTPUT_D'))", "D medium motor"),
    "a class that is given": ("def make(kind, port):\n    return kind(port)\nmake(MediumMotor, OUTPUT_D)",
                              "D medium motor"),
    "no port at all": ("MediumMotor()", "A medium motor"),
    "a port that is not known": ("import json\ncfg = json.load(open('x'))\nMediumMotor(cfg['arm'])", "A medium motor"),
    "two that are not known": ("p = input()\nMediumMotor(p)\nMediumMotor(input())", "A medium motor, D medium motor"),
    "never called": ("def unused():\n    MediumMotor(OUTPUT_A)", ""),
    "in a class that is not used": ("class C:\n    def __init__(self):\n        MediumMotor(OUTPUT_A)", ""),
    "in a thread": ("import threading\nclass T(threading.Thread):\n    def run(self):\n        MediumMotor(OUTPUT_A)\n"
                    "T().start()", "A medium motor"),
    "only imported": ("", ""),
    "a mux": ("TouchSensor('in1:i2c80:mux1')", ""),
    "a driver that is not simulated": ("Sensor(INPUT_1, driver_name='ht-nxt-compass')", ""),
    "two kinds on one port": ("ColorSensor('in1')\nTouchSensor('in1')\nTouchSensor('in1')", "1 touch"),
    "two gyros": ("GyroSensor('in1')\nGyroSensor('in4')", ""),
    "four colours": ("[ColorSensor(p) for p in (INPUT_1, INPUT_2, INPUT_3, INPUT_4)]", "1 middle, 4 front"),
    "four touches": ("[TouchSensor(p) for p in (INPUT_1, INPUT_2, INPUT_3, INPUT_4)]",
                     "1 touch, 2 touch_right, 3 touch_back, 4 touch_front"),
    "sensors that fill all ports": (
        "TouchSensor('in1')\nTouchSensor('in2')\nTouchSensor('in3')\nTouchSensor('in4')\nGyroSensor()",
        "1 touch, 2 touch_right, 3 touch_back, 4 touch_front",
    ),
    "refers to itself": ("a = b\nb = a\nMediumMotor(a)\nclass C(C): pass\nC()", "A medium motor"),
    "recursion": ("def f(p, n):\n    return f(p, n - 1) if n else MediumMotor(p)\nf(OUTPUT_D, 3)", "D medium motor"),
}  # fmt: skip


@pytest.mark.parametrize("case", PORTS)
def test_ports(case: str) -> None:
    text, expected = PORTS[case]
    assert changed(text) == expected


WHEELS: Mapping[str, tuple[str, str]] = {
    "steering": ("MoveSteering(OUTPUT_A, OUTPUT_B)", "A left wheel, B right wheel, C -"),
    "differential before tank": (
        "MoveTank(OUTPUT_A, OUTPUT_D)\nMoveDifferential(OUTPUT_B, OUTPUT_C, EV3EducationSetTire, 180)",
        "A large motor, D large motor",
    ),
    "a tank of arms": ("arms = MoveTank(OUTPUT_A, OUTPUT_D)\ndrive = MoveTank(OUTPUT_B, OUTPUT_C)",
                       "A large motor, D large motor"),
    "names": ("lift = LargeMotor(OUTPUT_C)\nrightMotor = LargeMotor(OUTPUT_A)\nleftMotor = LargeMotor(OUTPUT_B)",
              "A right wheel, C large motor"),
    "German names": ("motor_links = LargeMotor(OUTPUT_D)\nmotor_rechts = LargeMotor(OUTPUT_A)",
                     "A right wheel, B -, C -, D left wheel"),
    "short names": ("mL = LargeMotor(OUTPUT_D)\nmR = LargeMotor(OUTPUT_A)", "A right wheel, B -, C -, D left wheel"),
    "names of constants": ("L = OUTPUT_D\nR = OUTPUT_A\nm1 = LargeMotor(L)\nm2 = LargeMotor(R)",
                           "A right wheel, B -, C -, D left wheel"),
    "a class that holds two": (
        "arm = LargeMotor(OUTPUT_B)\nclass Car:\n    def __init__(self):\n        self.a = LargeMotor(OUTPUT_A)\n"
        "        self.d = LargeMotor(OUTPUT_D)\nCar()",
        "A left wheel, B large motor, C -, D right wheel",
    ),
    "three without names": ("[LargeMotor(p) for p in (OUTPUT_A, OUTPUT_B, OUTPUT_C)]", "A large motor"),
    "a single large motor": ("LargeMotor(OUTPUT_A)", "A large motor"),
    "a medium motor on the left wheel's port": ("MediumMotor(OUTPUT_B)", "A left wheel, B medium motor"),
    "medium motors left and right": ("left = MediumMotor(OUTPUT_A)\nright = MediumMotor(OUTPUT_D)",
                                     "A left wheel (medium motor), B -, C -, D right wheel (medium motor)"),
    "the same port twice": ("MoveTank(OUTPUT_B, OUTPUT_B)", ""),
    "medium motors on all ports": ("[MediumMotor(p) for p in (OUTPUT_A, OUTPUT_B, OUTPUT_C, OUTPUT_D)]",
                                   "A medium motor, B left wheel (medium motor), C right wheel (medium motor), "
                                   "D medium motor"),
    "as usual": ("tank = MoveTank(OUTPUT_B, OUTPUT_C)\nleft = LargeMotor(OUTPUT_B)", ""),
}  # fmt: skip


@pytest.mark.parametrize("case", WHEELS)
def test_wheels(case: str) -> None:
    text, expected = WHEELS[case]
    assert changed(text) == expected


SIZES: Mapping[str, tuple[str, tuple[float, float, float]]] = {
    "rim": ("MoveDifferential(OUTPUT_B, OUTPUT_C, EV3Rim, 100)", (30, 20, 100)),
    "by keyword": ("MoveDifferential(OUTPUT_B, OUTPUT_C, wheel_class=EV3Tire, wheel_distance_mm=9.5 * 10)",
                   (43.2, 21, 95)),
    "of a subclass": ("class W(EV3Tire): pass\nMoveDifferential(OUTPUT_B, OUTPUT_C, W, 180)", (43.2, 21, 180)),
    "with super": ("class W(Wheel):\n    def __init__(self):\n        super().__init__(diameter_mm=62.4, width_mm=20)\n"
                   "MoveDifferential(OUTPUT_B, OUTPUT_C, W, 150)", (62.4, 20, 150)),
    "impossible": ("MoveDifferential(OUTPUT_B, OUTPUT_C, EV3EducationSetTire, 0)", (56, 20, 180)),
}  # fmt: skip


@pytest.mark.parametrize("case", SIZES)
def test_what_a_differential_drive_says_about_its_wheels(case: str) -> None:
    text, expected = SIZES[case]
    found = built(text)
    robot = found.choice.spec if found else USUAL
    assert (robot.wheel_diameter_mm, robot.wheel_width_mm, robot.wheel_spacing_mm) == expected


@pytest.mark.parametrize(
    ("text", "reversed_"),
    [
        ("a, b = LargeMotor(OUTPUT_B), LargeMotor(OUTPUT_C)\na.polarity = b.polarity = 'inversed'", (True, True)),
        ("a, b = LargeMotor(OUTPUT_B), LargeMotor(OUTPUT_C)\nb.polarity = LargeMotor.POLARITY_INVERSED", (False, True)),
        ("t = MoveTank(OUTPUT_B, OUTPUT_C)\nt.left_motor.polarity = 'inversed'", (True, False)),
        ("t = MoveTank(OUTPUT_B, OUTPUT_C)\nt.set_polarity('inversed')\nt.set_polarity('normal')", (False, False)),
        ("m = MediumMotor(OUTPUT_A)\nm.polarity = 'inversed'", (False, False)),
    ],
    ids=["both", "one", "a motor of a tank", "to and fro", "no wheel"],
)
def test_a_wheel_with_polarity_turned_is_mounted_the_other_way_round(text: str, reversed_: tuple[bool, bool]) -> None:
    found = built(text)
    robot = found.choice.spec if found else USUAL
    assert (robot.left_reversed, robot.right_reversed) == reversed_


STOPS: Mapping[str, tuple[str, tuple[float | None, float | None]]] = {
    "stalled": ("m.on(-10)\nwhile not m.is_stalled: pass", (-45, 225)),
    "forwards, then far back": ("m.on(10)\nm.wait_until(m.STATE_STALLED)\nm.on_for_rotations(-20, 2)", (-765, 45)),
    "in the state": ("m.run_forever(speed_sp=-100)\nwhile 'stalled' not in m.state: pass", (-45, 225)),
    "no direction": ("m.on(speed)\nwhile not m.is_stalled: pass", (-225, 225)),
    "until it does not move": ("m.on(-10)\nm.wait_until_not_moving()", (-45, 225)),
    "a move that ends by itself": ("m.on_for_degrees(10, 90, block=False)\nm.wait_until_not_moving()", (None, None)),
    "no homing": ("m.on(10)\nm.off()", (None, None)),
    "until it is slow": ("m.duty_cycle_sp = -30\nm.run_direct()\nwhile abs(m.speed) > 5: pass", (-45, 225)),
    "then to an unknown place": (
        "m.on(-10)\nwhile not m.is_stalled: pass\nm.run_to_abs_pos(position_sp=x)",
        (-45, None),
    ),
    "then to places counted from there": (
        "m.on(-10)\nwhile not m.is_stalled: pass\nm.position = -300\nm.on_to_position(20, 270)",
        (-45, 615),
    ),
}


@pytest.mark.parametrize(
    ("text", "reversed_"),
    [
        ("def vorwaerts():\n    t.on(-40, -40)", True),
        ("def drive_forward(speed=40):\n    t.on_for_rotations(-speed, -speed, 2)", True),
        ("def forward():\n    t.on_for_degrees(-40, -40, -90)", False),
        ("def move_forward_or_back():\n    t.on(-40, -40)", False),
        ("def avanzar():\n    t.on(-40, 40)", False),
        ("t.set_polarity('inversed')\ndef forward():\n    t.on(-40, -40)", False),
    ],
    ids=["fixed", "by default", "a negative way", "both directions", "a turn", "with polarity turned"],
)
def test_wheels_that_turn_backwards_to_drive_forwards_are_mounted_the_other_way_round(
    text: str, reversed_: bool
) -> None:
    called = text[text.rindex("def ") + 4 :].split("(")[0]
    found = built(f"t = MoveTank(OUTPUT_A, OUTPUT_D)\n{text}\n{called}()")
    assert found is not None
    assert (found.choice.spec.left_reversed, found.choice.spec.right_reversed) == (reversed_, reversed_)


SAID_SIZES: Mapping[str, tuple[str, tuple[float, float]]] = {
    "with units": ("WHEEL_DIAMETER_CM = 6.24\naxle_track_mm = 118", (62.4, 118.0)),
    "without units": ("WHEEL_D = 6.24\nTRACK = 17.8", (62.4, 178.0)),
    "in a dict": ("config = {'wheel_diameter': 43.2, 'wheelbase': 120}", (43.2, 120.0)),
    "the circumference": ("WHEEL_CIRC_CM = 13.57", (43.2, 180.0)),
    "a default": ("def turn(deg, track_mm=88): pass\nturn(5)", (56.0, 88.0)),
    "a track of music": ("TRACK = 12", (56.0, 180.0)),
    "no size of a robot": ("WHEEL_MM = 5000", (56.0, 180.0)),
    "two sizes": ("WHEEL_MM = 30\nwheel_cm = 4.5", (56.0, 180.0)),
    "said to the library": (
        "MoveDifferential(OUTPUT_A, OUTPUT_D, EV3Tire, 100)\nWHEEL_MM = 50\nTRACK_MM = 90",
        (43.2, 100.0),
    ),
}


@pytest.mark.parametrize("case", SAID_SIZES)
def test_what_constants_say_about_wheels(case: str) -> None:
    text, expected = SAID_SIZES[case]
    found = built(f"MoveTank(OUTPUT_A, OUTPUT_D)\n{text}")
    assert found is not None
    assert (found.choice.spec.wheel_diameter_mm, found.choice.spec.wheel_spacing_mm) == expected


def test_constants_change_no_robot_that_has_everything_on_its_ports() -> None:
    assert built("MoveTank(OUTPUT_B, OUTPUT_C)\nWHEEL_MM = 30") is None


def test_motors_of_an_arm_are_no_wheels() -> None:
    arm = (
        "class Joint:\n    def __init__(self, motor):\n        self.motor = motor\n"
        "elbow, base = Joint(LargeMotor(OUTPUT_B)), Joint(LargeMotor(OUTPUT_C))\ngrip = MediumMotor(OUTPUT_A)\n"
        "limit = TouchSensor(INPUT_1)\nm = elbow.motor\nm.on_for_degrees(5, 40)\n"
        "m = base.motor\nm.on(-5)\nlimit.wait_for_pressed()"
    )
    found = built(arm)
    assert found is not None
    robot = found.choice.spec
    assert not robot.has_wheels
    assert [(touch.pressed_by, touch.pressed_at) for touch in robot.touch_sensors] == [("outC", "low")]


def test_bumpers_reach_to_the_corners_of_the_robot() -> None:
    found = built("MoveDifferential(OUTPUT_B, OUTPUT_C, EV3Tire, 130)\nl, r = TouchSensor('in1'), TouchSensor('in4')")
    assert found is not None
    robot = found.choice.spec
    reach = [(touch.x_mm - touch.width_mm / 2, touch.x_mm + touch.width_mm / 2) for touch in robot.touch_sensors]
    half_mm = (130 + robot.wheel_width_mm) / 2
    assert reach == [(-half_mm, 0), (0, half_mm)]


@pytest.mark.parametrize("case", STOPS)
def test_a_motor_that_drives_until_it_stalls_has_end_stops(case: str) -> None:
    text, expected = STOPS[case]
    found = built(f"m = MediumMotor(OUTPUT_A)\n{text}")
    assert found is not None
    (motor,) = found.choice.spec.extra_motors
    assert (motor.low_deg, motor.high_deg) == expected


def test_a_wheel_that_drives_until_it_stalls_has_no_end_stops() -> None:
    assert changed("m = LargeMotor(OUTPUT_B)\nm.on(10)\nwhile not m.is_stalled: pass") == ""


def test_a_touch_sensor_that_ends_the_way_of_an_arm_is_pressed_by_it() -> None:
    arm = "arm = MediumMotor(OUTPUT_A)\nts = TouchSensor(INPUT_1)\ntank = MoveTank(OUTPUT_B, OUTPUT_C)\n"
    by_arm = built(f"{arm}arm.on(-5)\nts.wait_for_pressed()")
    bumper = built(f"{arm}tank.on(5, 5)\nts.wait_for_pressed()")
    assert by_arm is not None and bumper is not None
    pressed = [robot.choice.spec.touch_sensors[0] for robot in (by_arm, bumper)]
    assert [(touch.pressed_by, touch.pressed_at) for touch in pressed] == [("outA", "low"), ("", "low")]


@pytest.mark.parametrize(
    ("text", "doubt"),
    [
        ("[LargeMotor(p) for p in (OUTPUT_A, OUTPUT_B, OUTPUT_C)]", "those on outB and outC are taken for the wheels"),
        ("MoveTank(OUTPUT_A, OUTPUT_D)\nMoveTank(OUTPUT_B, OUTPUT_C)", "MoveTank on outB and outC is taken"),
        ("ColorSensor('in1')\nTouchSensor('in1')\nTouchSensor('in1')", "in1 is taken for a touch sensor"),
        ("GyroSensor('in1')\nGyroSensor('in2')", "a robot has one gyro"),
    ],
    ids=["wheels", "pairs", "kinds", "gyros"],
)  # fmt: skip
def test_another_reading_is_told(text: str, doubt: str) -> None:
    found = built(text)
    assert found is not None
    assert any(doubt in one for one in found.doubts)


@pytest.mark.parametrize(
    "text",
    ["def f(:", "x = " + "(" * 3000, "x = " + "-" * 5000 + "1", "a.b" + ".c" * 5000 + "()", "import ev3dev2\0"],
    ids=["syntax", "brackets", "signs", "attributes", "null"],
)
def test_a_program_that_cannot_be_read_has_no_robot(text: str) -> None:
    assert built(text) is None


@pytest.mark.parametrize(
    "text",
    [
        "with open(os.path.join(HERE, 'ports.json')) as file:\n    ports = json.load(file)",
        "ports = json.loads(Path('ports.json').read_text())",
        "ports = json.load((Path(__file__).parent / 'ports.json').open())",
    ],
    ids=["open", "text", "path"],
)
def test_a_file_of_values_beside_the_program_is_read(tmp_path: Path, text: str) -> None:
    (tmp_path / "ports.json").write_text('{"arm": ["outD"]}')
    head = f"{HEAD}import json, os\nfrom pathlib import Path\nHERE = os.path.dirname(__file__)\n"
    source = f"{head}{text}\nMediumMotor(ports['arm'][0])"
    robot = facts_of(Program("p.py", source, path=str(tmp_path / "p.py"))).robot
    assert robot is not None
    assert [motor.port for motor in robot.choice.spec.extra_motors] == ["outD"]


@pytest.mark.parametrize(
    "name",
    [
        "../ports.json",
        "link.json",
        "/absolute",
        "none.json",
        "folder",
        "pipe",
        "large.json",
        "deep.json",
        "rubbish.json",
    ],
)
def test_no_other_file_is_read(tmp_path: Path, name: str) -> None:
    folder = tmp_path / "own"
    (folder / "folder").mkdir(parents=True)
    ports = '{"arm": "outD"}'
    (tmp_path / "ports.json").write_text(ports)
    (folder / "link.json").symlink_to(tmp_path / "ports.json")
    os.mkfifo(folder / "pipe")
    (folder / "large.json").write_text(ports + " " * 70_000)
    (folder / "deep.json").write_text("[" * 60_000)
    (folder / "rubbish.json").write_bytes(b"\xff{")
    given = str(tmp_path / "ports.json") if name == "/absolute" else name
    source = f"{HEAD}import json\nports = json.load(open({given!r}))\nMediumMotor(ports['arm'])"
    robot = facts_of(Program("p.py", source, path=str(folder / "p.py"))).robot
    assert robot is None or all(motor.port != "outD" for motor in robot.choice.spec.extra_motors)


def test_modules_of_its_own_are_read_wherever_they_lie(tmp_path: Path) -> None:
    (tmp_path / "parts" / "deep").mkdir(parents=True)
    (tmp_path / "parts" / "__init__.py").write_text("from .deep import arm\n")
    (tmp_path / "parts" / "deep" / "arm.py").write_text(
        "from ev3dev2.motor import MediumMotor\nfrom ..ports import ARM\nimport main\nmotor = MediumMotor(ARM)\n"
        "if __name__ == '__main__':\n    MediumMotor('outD')\n"
    )
    (tmp_path / "parts" / "ports.py").write_text("ARM = 'outA'\n")
    (tmp_path / "main.py").write_text("import parts\nparts.arm.motor.on(5)\n")
    os.mkfifo(tmp_path / "pipe.py")
    text = (tmp_path / "main.py").read_text() + "import pipe, missing, json\n"
    facts = facts_of(Program("main.py", text, path=str(tmp_path / "main.py")))
    assert facts.for_brick and facts.robot is not None
    assert [part.what for part in facts.robot.parts if part.changes] == ["medium motor on outA"]
    assert str(facts.robot.parts[-1].where) == "parts/deep/arm.py, line 4"
