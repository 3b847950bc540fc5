"""Lines of a program that do nothing, or always the same."""

from __future__ import annotations

from tests.cases import cases, for_rows
from tuisim.base.source import Program
from tuisim.programs.facts import read_facts


def find_slip(text: str) -> tuple[int, str] | None:
    """The only slip of a program; None for none."""
    slips = read_facts(Program("p.py", text)).slips
    assert len(slips) < 2
    return slips[0] if slips else None


@cases(
    "text, idle",
    {
        "no return": (
            "def near():\n    us < 9\n",
            (2, "near() returns nothing: return is missing before us < 9"),
        ),
        "another return": (
            "def near():\n    if 1: return 2\n    us < 9\n",
            (3, "us < 9 alone does nothing: the answer is not used"),
        ),
        "no assignment": ("x = 1\nx == 3\n", (2, "x == 3 only compares: x = 3 sets it")),
        "the first": (
            "if 1:\n    a < b\nb < a\n",
            (2, "a < b alone does nothing: the answer is not used"),
        ),
        "whether it raises": ("try:\n    a < b\nexcept TypeError:\n    pass\n", None),
        "what is used": ("x = a < b\nprint(a == b)\nwhile a < b: pass\n'a < b'\n", None),
    },
)
def test_a_comparison_that_nothing_uses_is_named(text: str, idle: tuple[int, str] | None) -> None:
    assert find_slip(text) == idle


@cases(
    "text, missing",
    {
        "a condition": (
            "def dark():\n    x = us < 9\nwhile not dark():\n    pass\n",
            (
                3,
                "dark() returns nothing, so this is always true: return is missing in line 1 and on",
            ),
        ),
        "a result": ("def dark():\n    return us < 9\nwhile not dark():\n    pass\n", None),
        "no question": ("def dark():\n    x = us < 9\ndark()\n", None),
        "an error": ("def dark():\n    raise E\nif dark():\n    pass\n", None),
    },
)
def test_a_question_to_a_function_without_a_result_is_named(
    text: str, missing: tuple[int, str] | None
) -> None:
    assert find_slip(text) == missing


@cases(
    "text, equal",
    {
        "else": ("if a:\n    b()\nelse:\n    b()\n", (1, "if and else do the same")),
        "one of three": ("if a:\n    b()\nelif c:\n    b()\nelse:\n    d()\n", None),
    },
)
def test_two_ways_that_do_the_same_are_named(text: str, equal: tuple[int, str] | None) -> None:
    assert find_slip(text) == equal


@cases(
    "text, definition",
    {
        "a function": ("import a\nN = 3\ndef main():\n    a.b()\n", (3, "main()")),
        "the last": ("'Robot.'\nm = Motor(Port.A)\ndef f(): pass\nclass Arm: pass\n", (4, "Arm()")),
        "a call": ("def main(): pass\nmain()\n", None),
        "a value of a call": ("def main(): pass\nx = main()\n", None),
        "a main part": ("def main(): pass\nif __name__ == '__main__':\n    main()\n", None),
        "nothing": ("import a\n", None),
    },
)
def test_a_program_that_only_defines_functions_is_told_of(
    text: str, definition: tuple[int, str] | None
) -> None:
    idle = read_facts(Program("p.py", text)).idle_definition
    if definition is None:
        assert idle is None
    else:
        line, call = definition
        assert idle == (line, f"the program only defines, and calls nothing: {call} is missing")


@cases(
    "text, slip",
    {
        "seconds as ms": (
            "robot.drive(200, 0)\nwait(3)\nrobot.stop()\n",
            (2, "wait(3) waits only 3 ms: wait(3000) waits 3 s"),
        ),
        "in a loop": (
            "while 1:\n    motor.run(200)\n    wait(0.5)\n    motor.brake()\n",
            (3, "wait(0.5) waits only 0.5 ms: wait(500) waits 0.5 s"),
        ),
        "long": ("robot.drive(200, 0)\nwait(300)\nrobot.stop()\n", None),
        "no stop": ("robot.drive(200, 0)\nwait(3)\nrobot.drive(0, 9)\n", None),
        "a wait of something else": ("robot.drive(200, 0)\nself.wait(3)\nrobot.stop()\n", None),
    },
)
def test_a_wait_of_a_few_milliseconds_meant_as_seconds_is_named(
    text: str, slip: tuple[int, str] | None
) -> None:
    assert find_slip(text) == slip


def test_a_value_alone_on_a_line_is_not_told_to_be_called() -> None:
    slip = find_slip("eye.color\n")
    assert slip is not None
    assert slip[1].startswith(
        "eye.color alone does nothing: eye.color() calls it if it is a method"
    )


HUB = "from pybricks.hubs import Hub; hub = eye = self.bumper = motor = Hub()\n"


@for_rows(
    "text, slip",
    {
        "compared": (
            f"{HUB}while eye.color != 3:\n    pass\n",
            (2, "eye.color without () is not a value: eye.color() gives one"),
        ),
        "computed with": (
            f"{HUB}turn = 90 - hub.imu.heading\n",
            (2, "hub.imu.heading without () is not a value: hub.imu.heading() gives one"),
        ),
        "compared by another name": (
            f"{HUB}color = eye.color\nif color == 3:\n    pass\n",
            (2, "eye.color without () is not a value: eye.color() gives one"),
        ),
        "tested": (
            f"{HUB}if not self.bumper.pressed:\n    pass\n",
            (2, "self.bumper.pressed without () is not a value: self.bumper.pressed() gives one"),
        ),
        "printed": (
            f"{HUB}print('now', f'{{motor.angle}}')\n",
            (2, "motor.angle without () is not a value: motor.angle() gives one"),
        ),
        "called": (f"{HUB}while eye.color() != 3:\n    print(eye.color())\n", None),
        "passed on": (f"{HUB}wait_until(self.bumper.pressed)\nread = eye.color\n", None),
        "an attribute of something else": (f"{HUB}print(step.angle + 1)\n", None),
        "a property": (
            f"{HUB}class A:\n    @property\n    def angle(self): return 1\nprint(A().angle)\n",
            None,
        ),
        "a value of ev3dev2": ("print(eye.color + 1)\n", None),
    },
)
def test_a_method_that_is_used_as_a_value_is_named(text: str, slip: tuple[int, str] | None) -> None:
    assert find_slip(text) == slip


METHOD = "TypeError: '<' not supported between instances of 'method' and 'int'"
NONE = "TypeError: unsupported operand type(s) for +: 'NoneType' and 'int'"
MEASURE = "def measure():\n    x = 1\n"


@for_rows(
    "text, error, cause",
    {
        "a method": (
            "\n\nif eye.value < 5: pass\n",
            METHOD,
            "eye.value without () is not a value: eye.value() gives one",
        ),
        "a function": (
            "def far(): return 1\n\nif far < 5: pass\n",
            METHOD.replace("method", "function"),
            "far without () is not a value: far() gives one",
        ),
        "a method by another name": (
            "light = eye.value\n\nif light < 5: pass\n",
            METHOD,
            "eye.value without () is not a value: eye.value() gives one",
        ),
        "one of two attributes": ("\n\nif eye.value < self.limit: pass\n", METHOD, ""),
        "no result": (
            f"{MEASURE}print(measure() + 1)\n",
            NONE,
            "measure() is None: measure(), line 1, has no return",
        ),
        "no result in a name": (
            "x = measure()\ndef measure(): print(5)\ny = x + 1\n",
            NONE,
            "x is None: measure(), line 2, has no return",
        ),
        "no result of a method": (
            "def look(self): pass\nrobot.light = robot.look()\nrobot.light.show()\n",
            "AttributeError: 'NoneType' object has no attribute 'show'",
            "robot.light is None: look(), line 1, has no return",
        ),
        "a result": ("def measure(): return 1\nx = measure()\ny = x + 1\n", NONE, ""),
        "another error": (f"{MEASURE}print(measure() + 1)\n", "ValueError: x", ""),
    },
)
def test_what_an_error_does_not_name_is_found_in_its_line(
    text: str, error: str, cause: str
) -> None:
    assert read_facts(Program("p.py", text)).explain_error(error, 3) == cause


@cases(
    "text, uncalled",
    {
        "alone": (
            "def main():\n    go()\nmain\n",
            (3, "main without () does nothing: main() calls it"),
        ),
        "a condition": (
            "def dark():\n    return us < 9\nwhile not dark:\n    go()\n",
            (3, "dark without () is always true: dark() asks"),
        ),
        "called": ("def dark():\n    return us < 9\nwhile not dark():\n    go()\n", None),
        "a parameter": ("def dark():\n    go()\ndef f(dark):\n    if dark:\n        dark()\n", None),
        "replaced": ("def dark():\n    go()\ndark = None\nif dark:\n    dark()\n", None),
        "a state": ("def seek():\n    go()\nstate = seek\nif state == seek:\n    state()\n", None),
    },
)  # fmt: skip
def test_a_function_that_is_named_but_not_called_is_told(
    text: str, uncalled: tuple[int, str] | None
) -> None:
    assert find_slip(text) == uncalled


@cases(
    "text, slip",
    {
        "in capitals": (
            "eye = ColorSensor(Port.S2)\nwhile eye.color() != 'BLACK':\n    go()\n",
            (2, "a text equals no colour: write Color.BLACK"),
        ),
        "a number": (
            "if colorLeft.color == 'Red':\n    go()\n",
            (1, "color is a number: color_name is the word"),
        ),
        "a wait": ("while colorLeft.color != 'Red':\n    go()\n", None),
        "a name": ("if colorLeft.color_name == 'Red':\n    go()\n", None),
        "of something else": ("card = Card('red')\nif card.color == 'red':\n    go()\n", None),
        "an own sensor": (
            "class ColorSensor:\n    color = 'Red'\neye = ColorSensor()\nif eye.color == 'Red':\n    go()\n",
            None,
        ),
        "an own name": ("colorLeft = Card('red')\nif colorLeft.color == 'red':\n    go()\n", None),
    },
)  # fmt: skip
def test_a_colour_that_is_compared_with_a_text_is_told(
    text: str, slip: tuple[int, str] | None
) -> None:
    assert find_slip(text) == slip
