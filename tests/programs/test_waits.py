"""What ends a loop, and how far a call turns motors, by the text of a program."""

from __future__ import annotations

from functools import partial

from tests.cases import cases, for_each, for_rows
from tests.effort import count_calls
from tuisim.base.source import Program
from tuisim.programs.facts import ProgramFacts, read_facts

WAITED_FOR = {
    "an angle": ("while gyro.angle < 90:\n    pass", ">=", 90, "angle", 1),
    "a method": ("while cs.reflection() > 30:\n    wait(5)", "<=", 30, "reflection", 1),
    "the constant first": ("while -5 >= gyro.rate:\n    pass", ">", -5, "rate", 1),
    "a colour": ("while cs.color_name != 'Red':\n    pass", "==", "Red", "color_name", 1),
    "a colour of a library": ("while cs.color() != Color.RED:\n    pass", "==", "RED", "color", 1),
    "a named limit": ("def go():\n    while a.value() < MAX: pass\nMAX = -4", ">=", -4, "value", 2),
    "a limit that is passed on": (
        "def go(limit):\n    while a.value(0) < limit: pass\nLOW = 3\ngo(LOW)\ngo(3)",
        ">=",
        3,
        "value",
        2,
    ),
    "a limit that is computed": (
        "LOW = 3\nwhile LOW * 10 - 5 < a.angle:\n    pass",
        "<=",
        25,
        "angle",
        2,
    ),
    "a number that is added": (
        "x = 5\nwhile 2 + us.distance() - x > 50:\n    pass",
        "<=",
        53,
        "distance",
        2,
    ),
    "a break": ("while True:\n    if gyro.angle > 90:\n        break\n", ">", 90, "angle", 2),
    "one of two": (
        "while btn.enter == False and us.distance() > 50:\n    wait(5)",
        "<=",
        50,
        "distance",
        1,
    ),
    "a variable": (
        "v = cs.color\nwhile v == 1:\n    v = cs.color\n    show(v)",
        "!=",
        1,
        "color",
        3,
    ),
}


def read(text: str) -> ProgramFacts:
    return read_facts(Program("p.py", text))


@for_rows("text, operator, limit, attribute, line", WAITED_FOR)
def test_a_loop_that_compares_a_reading_with_a_constant_is_found_as_a_wait(
    text: str, operator: str, limit: str | int, attribute: str, line: int
) -> None:
    (end,) = read(text).loop_ends
    assert (end.operator, end.limit) == (operator, limit)
    assert (end.attribute, end.read_line, end.set_line) == (attribute, line, 0)


@for_each(
    text=[
        "while True:\n    follow()",
        "while running == True:\n    drive()",
        "while gyro.angle < goal:\n    pass",
        "goal = 1\nwhile gyro.angle < goal:\n    goal += 1",
        "def go(goal):\n    while gyro.angle < goal:\n        pass\ngo(1)\ngo(2)",
        "def go(goal):\n    while gyro.angle < goal:\n        pass\ngo(find())",
        "while 0 < gyro.angle < 90:\n    pass",
        "while max(a.angle, b.angle) < 90:\n    pass",
        "while 10 - a.angle > 90:\n    pass",
        "while a.angle + b.angle > 90:\n    pass",
        "v = 1\nwhile v > 0:\n    v = look()",
        "v = 1\ndef press():\n    global v\n    v = 0\ndef go():\n    while v > 0:\n        pass",
        "v = 1\ndef go():\n    while v > 0:\n        rest()\ndef press():\n    global v\n    v = 0",
        "while gyro.angle <",
        "run = 1\nwhile run == 1:\n    follow()",
        "v = cs.color\nwhile v != 5:\n    if touch.is_pressed:\n        break",
        "v = 1\nwhile v > 0 and ready():\n    wait(5)",
        "while gyro.angle < 90 or ready():\n    wait(5)",
        "while True:\n    if gyro.angle > 90:\n        stop()",
    ]
)
def test_no_end_is_named_for_loops_whose_condition_is_not_a_simple_comparison(text: str) -> None:
    assert read(text).loop_ends == ()


@cases(
    "text, end",
    {
        "a change": ("a = g.angle\nwhile g.angle - a < 90: pass", (">=", 90, "angle", 1)),
        "a change with a name": (
            "a = g.angle\nwhile way < 90: way = g.angle - a",
            (">=", 90, "angle", 1),
        ),
        "the other way round": (
            "a = g.angle\nwhile a - g.angle < 90: pass",
            ("<=", -90, "angle", 1),
        ),
        "an aim": ("a = g.angle + 90\nwhile g.angle < a: pass", (">=", 90, "angle", 1)),
        "an aim in the loop": (
            "a = m.angle()\nwhile m.angle() > a - 9: pass",
            ("<=", -9, "angle", 1),
        ),
        "an aim by a name": (
            "a = g.angle\nb = a + 9\nwhile g.angle < b: pass",
            (">=", 9, "angle", 1),
        ),
    },
)
def test_a_loop_that_compares_a_change_names_the_line_of_the_first_reading(
    text: str, end: tuple[str, int, str, int]
) -> None:
    (loop,) = read(text).loop_ends
    assert (loop.operator, loop.limit, loop.attribute, loop.start_line) == end


@for_rows(
    "text, line",
    {
        "never counted": ("n = 0\nwhile n < 4:\n    go()", 1),
        "counted": ("n = 0\nwhile n < 4:\n    n += 1", None),
        "counted in a function": (
            "n = 0\ndef go():\n    global n\n    n += 1\nwhile n < 4:\n    go()",
            None,
        ),
        "not entered": ("n = 9\nwhile n < 4:\n    go()", None),
        "left by a break": ("n = 0\nwhile n < 4:\n    if go(): break", None),
        "a flag": ("n = 0\nwhile n == 0:\n    go()", None),
        "a flag that is compared": ("n = 1\nwhile n > 0:\n    go()", None),
        "a parameter": ("n = 0\ndef f(n):\n    while n < 4:\n        go()", None),
    },
)
def test_a_loop_that_does_not_count_names_the_line_of_its_first_number(
    text: str, line: int | None
) -> None:
    assert [loop.set_line for loop in read(text).loop_ends if loop.is_count] == (
        [line] if line else []
    )


def test_a_loop_on_a_value_read_only_before_names_the_line_that_read_it() -> None:
    (end,) = read("v = cs.color\nv = cs.color\nwhile v != 5:\n    sleep(1)\n").loop_ends
    assert (end.name, end.set_line, end.is_count) == ("v", 2, False)


def test_loops_are_listed_from_the_inside() -> None:
    text = "x = 0\nwhile gyro.angle < 90:\n    while y.angle != 1:\n        x += 0.1\n"
    inner, outer = read(text).loop_ends
    assert (inner.line, outer.line, outer.last_line) == (3, 2, 4)


@cases(
    "call, turns",
    {
        "rotations": ("tank.on_for_rotations(SpeedPercent(5), 30, 360)", (360, "rotations")),
        "degrees by name": ("m.on_for_degrees(30, degrees=-90, brake=True)", (-90, "degrees")),
        "an angle of pybricks": ("m.run_angle(300, 720, wait=False)", (720, "degrees")),
        "a variable": ("m.on_for_degrees(SpeedPercent(5), far)", None),
        "seconds": ("m.on_for_seconds(30, 5)", None),
    },
)
def test_the_angle_or_rotations_of_a_motor_call_are_found(
    call: str, turns: tuple[float, str] | None
) -> None:
    assert read(f"# first\n{call}\n").find_turns(2) == turns
    assert read(call).find_turns(2) is None


@for_rows(
    "text, line",
    {
        "a tank": ("import x\ntank.on(30, 30)", 2),
        "a motor of the old library": ("m.run_forever(speed_sp=9)", 1),
        "in a function": ("def go():\n    base.drive(9, 0)\n\ngo()", 2),
        "in a function that is not called": ("def go():\n    base.drive(9, 0)", 0),
        "for a time": ("tank.on_for_seconds(9, 9, 1)", 1),
        "a lamp": ("ev3.light.on(Color.RED)", 0),
        "no motor": ("asyncio.run(main())\nsubprocess.run([1])\nprint(1)", 0),
        "no Python": ("tank.on(", 0),
    },
)
def test_the_first_line_that_starts_motors_is_told(text: str, line: int) -> None:
    assert read(text).first_drive == line


def _read_loop_ends(text: str) -> object:
    return read(text).loop_ends


def test_twice_as_many_functions_take_at_most_three_times_the_work() -> None:
    small, large = (
        "".join(f"def f{number}(a):\n    f{number}(a)\n" for number in range(count))
        for count in (40, 80)
    )
    few, many = (count_calls(partial(_read_loop_ends, text)) for text in (small, large))
    assert many < 3 * few
