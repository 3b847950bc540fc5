"""Errors of programs for which Python has no hint."""

from __future__ import annotations

from tests.cases import cases
from tests.running import Run

HINTS = {
    "a part of a name": (
        "colorLeft.reflected_light",
        "'ColorSensor' object has no attribute 'reflected_light'. Did you mean: 'reflected_light_intensity'?",
    ),
    "another word": (
        "tank_drive.forward(3)",
        "'MoveTank' object has no attribute 'forward'. Did you mean: 'on'?",
    ),
    "a name that Python suggests": (
        "tank_drive.onn(1)",
        "'MoveTank' object has no attribute 'onn'. Did you mean: 'on'?",
    ),
    "a number after text": (
        "'Colour: ' + colorLeft.reflected_light_intensity",
        'can only concatenate str (not "int") to str. `str(number)` makes text of a number, '
        "`float(text)` a number of text",
    ),
    "a value that is called": (
        "x = 2 * (colorLeft.reflected_light_intensity() + 1)",
        "'int' object is not callable. reflected_light_intensity is a value: leave out the ()",
    ),
    "two calls, of which either may be wrong": (
        "ultrasonic.value() + colorLeft.reflected_light_intensity()",
        "'int' object is not callable",
    ),
    "a value of the program that is called": ("x = 3\nx()", "'int' object is not callable"),
    "a text that is no number": (
        "int('two')",
        "invalid literal for int() with base 10: 'two'",
    ),
    "a number before text": (
        "1.5 + ' cm'",
        "unsupported operand type(s) for +: 'float' and 'str'. `str(number)` makes text of a number, "
        "`float(text)` a number of text",
    ),
    "an object of the program": (
        "class Mine:\n    light_left = 1\nMine().light",
        "'Mine' object has no attribute 'light'",
    ),
    "a text for a number of rotations": (
        "n = ' 2 '\ntank_drive.on_for_rotations(20, 20, n)",
        "can't multiply sequence by non-int of type 'float'. n is a text: float(n) is its number",
    ),
    "a text for a speed, in a function": (
        "def go(speed):\n    tank_drive.on(SpeedPercent(speed), 20)\ngo('-3.5')",
        "'<' not supported between instances of 'str' and 'int'. "
        "speed is a text: float(speed) is its number",
    ),
    "a text that is no number, for a speed": (
        "speed = 'fast'\ntank_drive.on(SpeedPercent(speed), 20)",
        "'<' not supported between instances of 'str' and 'int'",
    ),
    "text and a list": ("'a' + []", 'can only concatenate str (not "list") to str'),
}


@cases("text, words", HINTS)
def test_an_error_has_a_hint(run: Run, text: str, words: str) -> None:
    done = run(text, prelude="preloaded")
    summary = done.ended.summary.partition(": ")[2]
    assert summary.rpartition(" (line")[0] == words
    assert words in "\n".join(done.errors)


IMPORTS = {
    "a module": ("time.sleep(1)", "Did you forget to import 'time'?"),
    "a function of a module": ("sleep(1)", "Did you forget `from time import sleep`?"),
    "a class of ev3dev2": (
        "MoveTank",
        "Did you forget `from ev3dev2.motor import MoveTank`?",
    ),
    "a class that the predefined names lack": (
        "LargeMotor",
        "Did you forget `from ev3dev2.motor import LargeMotor`?",
    ),
    "a name like one of the program": (
        "MoveTonk = 1\nMoveTank",
        "Did you mean: 'MoveTonk'? Or did you forget `from ev3dev2.motor import MoveTank`?",
    ),
}
PYBRICKS_IMPORTS = {
    "a parameter": ("Port.A", "Did you forget `from pybricks.parameters import Port`?"),
    "a function": ("wait(1)", "Did you forget `from pybricks.tools import wait`?"),
    "a device": ("Motor", "Did you forget `from pybricks.ev3devices import Motor`?"),
    "a name of Python": ("sleep(1)", "Did you forget `from time import sleep`?"),
    "a name like one of the program": (
        "Moter = 1\nMotor",
        "Did you mean: 'Moter'? Or did you forget `from pybricks.ev3devices import Motor`?",
    ),
}


@cases("text, words", IMPORTS)
def test_a_name_that_is_not_imported_tells_the_import(run: Run, text: str, words: str) -> None:
    assert f"is not defined. {words}" in run(text, prelude="none").ended.summary


@cases("text, words", PYBRICKS_IMPORTS)
def test_a_name_of_pybricks_tells_its_import(run: Run, text: str, words: str) -> None:
    assert (
        f"is not defined. {words}"
        in run(text, prelude="none", profile="lego-micropython").ended.summary
    )


def test_a_name_that_no_library_has_gets_no_import(run: Run) -> None:
    assert run("colour").ended.summary == "NameError: name 'colour' is not defined (line 1)"


def test_a_port_that_the_brick_does_not_have_tells_its_ports(run: Run) -> None:
    text = "from pybricks.parameters import Port\nPort.G"
    summary = run(text, prelude="none", profile="lego-micropython").ended.summary
    assert summary == "AttributeError: G. Port has only A, B, C, D, S1, S2, S3, S4 (line 2)"
