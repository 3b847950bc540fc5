"""Which lines of a program depend on a reading: those that compute from one, and those that one decides on."""

from __future__ import annotations

import math

import pytest

from tuisim.goals.provenance import Provenance, provenance_of
from tuisim.goals.spec import Reading

VALUE, DECIDED, FREE = (True, True), (False, True), (False, False)

LINES = {
    "printed": ("print(colorLeft.reflected_light_intensity_pc)", 1, VALUE),
    "literal": ("print('Grey: 50.2')", 1, FREE),
    "literal beside a reading": ("colorLeft.rgb; print('Grey: 50.2')", 1, FREE),
    "variable": ("x = colorLeft.rgb[0]\ny = x / 2\nprint('G', y)", 3, VALUE),
    "another variable": ("x = colorLeft.rgb[0]\ny = 50.2\nprint('G', y)", 3, FREE),
    "reading times nothing": ("x = colorLeft.rgb[0]\nprint('G', 50.2 + 0 * x)", 2, FREE),
    "nothing times a reading": ("print('G', 50.2 + colorLeft.rgb[0] * 0.0)", 1, FREE),
    "in several lines": ("print(\n    'Grey:',\n    colorLeft.rgb,\n)", 1, VALUE),
    "two names at once": ("a, b = colorLeft.rgb[:2]\nprint(b)", 2, VALUE),
    "attribute": ("robot.light = colorLeft.rgb\nprint(robot.light)", 2, VALUE),
    "list": ("a = []\na.append(colorLeft.color)\nfor x in a:\n    print(x)", 4, VALUE),
    "literal list": ("colorLeft.color\nfor x in ['Red']:\n    print(x)", 3, FREE),
    "returned": ("def light():\n    return colorLeft.rgb\nprint(light())", 3, VALUE),
    "passed": ("def show(x):\n    print(x)\nshow(colorLeft.color)", 2, VALUE),
    "passed a literal": ("def show(x):\n    print(x)\nshow('Red')", 2, FREE),
    "passed where a reading decides": (
        "def show(x):\n    print(x)\nif colorLeft.color == 5:\n    show('Red')",
        2,
        VALUE,
    ),
    "chosen": (
        "if colorLeft.color == 5:\n    name = 'Red'\nelse:\n    name = ''\nprint(name)",
        5,
        VALUE,
    ),
    "chosen in an expression": ("print('Red' if colorLeft.color == 5 else '')", 1, VALUE),
    "under an if": ("if colorLeft.color == 5:\n    print('Red')", 2, DECIDED),
    "under another if": ("colorLeft.color\nif 1 < 2:\n    print('Red')", 3, FREE),
    "after a loop that a reading ends": (
        "while colorLeft.color != 5:\n    pass\nprint('Red')",
        3,
        DECIDED,
    ),
    "before that loop": ("print('Red')\nwhile colorLeft.color != 5:\n    pass", 1, FREE),
    "after a break": (
        "while True:\n    if colorLeft.color == 5:\n        break\nprint('Red')",
        4,
        DECIDED,
    ),
    "after a loop of the clock": (
        "while get_clock() < 5:\n    colorLeft.color\nprint('Red')",
        3,
        FREE,
    ),
    "counted": ("n = 0\nwhile colorLeft.color != 5:\n    n = n + 1\nprint(n)", 4, VALUE),
    "counted otherwise": ("n = 0\nwhile colorLeft.color != 5:\n    n += 1\nprint(n)", 4, VALUE),
    "set in that loop": ("while colorLeft.color != 5:\n    n = get_clock()\nprint(n)", 3, DECIDED),
    "match": ("match colorLeft.color:\n    case 5:\n        print('Red')", 3, DECIDED),
    "walrus": ("while (c := colorLeft.color) != 5:\n    print(c)", 2, VALUE),
    "method": (
        "class R:\n    def see(self):\n        return colorLeft.color\nprint(R().see())",
        4,
        VALUE,
    ),
    "thread": (
        "def f():\n    print('Red')\nwhile colorLeft.color != 5:\n    pass\nThread(target=f).start()",
        2,
        DECIDED,
    ),
    "try": ("try:\n    x = colorLeft.color\nfinally:\n    print(x)", 4, VALUE),
    "unknown line": ("print('Red')", 9, VALUE),
}


@pytest.mark.parametrize(("text", "line", "depends"), LINES.values(), ids=LINES)
def test_what_a_line_depends_on(text: str, line: int, depends: tuple[bool, bool]) -> None:
    found = Provenance(text, Reading.COLOR)
    assert (found.gives(line), found.decides(line)) == depends


def test_lines_that_read() -> None:
    text = "x = colorLeft.rgb\ny = gyro.angle\nprint(\n    colorRight\n    .color\n)"
    assert Provenance(text, Reading.COLOR).lines() == {1, 4, 5}
    assert Provenance(text, Reading.GYRO).lines() == {2}


PAUSES = {
    "robot.turn(90 - gyro.angle())": True,
    "arm.run_target(100, gyro.angle())": True,
    "motor.run(gyro.speed())": False,
    "robot.drive(100, -2 * gyro.angle())": False,
}


@pytest.mark.parametrize(("text", "pauses"), PAUSES.items(), ids=PAUSES)
def test_a_move_of_pybricks_that_blocks_also_lets_time_pass(text: str, pauses: bool) -> None:
    assert Provenance(text, Reading.GYRO).pauses_s() == ({1: math.inf} if pauses else {})


@pytest.mark.parametrize("text", ["print(robot.state()[0])", "print(arm.run_until_stalled(-100))"])
def test_what_pybricks_tells_of_its_motors_is_a_reading(text: str) -> None:
    assert Provenance(text, Reading.MOTOR).gives(1)


def test_text_that_is_no_python() -> None:
    assert provenance_of("print(", Reading.COLOR) is None


@pytest.mark.parametrize(("name", "given"), [("G", True), ("L", False), ("", False)])
def test_line_that_prints_twice_is_about_what_has_the_name(name: str, given: bool) -> None:
    found = Provenance("print('L: 5'); print(f'G: {colorLeft.color:.0f}')", Reading.COLOR)
    assert found.gives(1, name) is given


def test_print_that_goes_on_is_one_with_the_next() -> None:
    found = Provenance("print('G: ', end=''); print(colorLeft.color)", Reading.COLOR)
    assert found.gives(1, "G")


PAUSE_S = {
    "sleep(0.05); x = colorLeft.color": {1: 0.05},
    "wait(50); x = eye.color(); time.sleep(1)": {1: 1.05},
    "sleep(t); x = colorLeft.color": {1: math.inf},
    "sleep(0.05)\nx = colorLeft.color": {},
}


@pytest.mark.parametrize(("text", "pauses_s"), PAUSE_S.items(), ids=PAUSE_S)
def test_how_long_a_line_that_reads_pauses(text: str, pauses_s: dict[int, float]) -> None:
    assert Provenance(text, Reading.COLOR).pauses_s() == pytest.approx(pauses_s)


MODULE = """\
def light(sensor):
    return sensor.rgb[0]
def twice(sensor):
    return 2 * light(sensor)
def greys(sensor):
    while True:
        yield sensor.rgb[0]
def show(sensor):
    print(sensor.rgb[0])
def tell(sensor):
    if sensor.color == 5:
        print('Red')
def lie(sensor):
    sensor.color
    print('Grey: 50.2')
def drive(color):
    return 50.2
class Eye:
    @property
    def level(self):
        return self.sensor.rgb[0]
"""
USES = {
    "value": ("print(helper.light(colorLeft))", 1, VALUE, {1}),
    "of another function": ("x = helper.twice(colorLeft)\nprint(x)", 2, VALUE, {1}),
    "imported": ("from helper import light\nx = light(colorLeft)\nprint(x)", 3, VALUE, {2}),
    "generator": ("for x in helper.greys(colorLeft):\n    print(x)", 2, VALUE, {1}),
    "kept generator": (
        "g = helper.greys(colorLeft)\nx = next(g)\nfor y in g:\n    print(y)",
        4,
        VALUE,
        {1, 2, 3},
    ),
    "property": ("print(eye.level)", 1, VALUE, {1}),
    "printed there": ("helper.show(colorLeft)", 1, VALUE, {1}),
    "decided there": ("helper.tell(colorLeft)", 1, DECIDED, {1}),
    "not computed there": ("helper.lie(colorLeft)", 1, FREE, {1}),
    "nothing read there": ("print(helper.drive(5))", 1, FREE, set()),
}


@pytest.mark.parametrize(("text", "line", "depends", "lines"), USES.values(), ids=USES)
def test_what_a_module_reads(
    text: str, line: int, depends: tuple[bool, bool], lines: set[int]
) -> None:
    found = Provenance(text, Reading.COLOR, [MODULE, "def broken("])
    assert (found.gives(line), found.decides(line), set(found.lines())) == (*depends, lines)
