"""Conditions that are never or always true, and branches that are never reached."""

from __future__ import annotations

from tests.cases import cases, for_rows
from tuisim.base.source import Program
from tuisim.programs.facts import read_facts


def list_texts(text: str) -> list[str]:
    return [words for _, words in read_facts(Program("p.py", text)).slips]


@for_rows(
    "test, words",
    {
        "two sides": (
            "x < 85 and x > 90",
            "x < 85 and x > 90 is never true: for a value between them write 85 < x < 90, "
            "for one outside or instead of and",
        ),
        "a chain": ("90 < x < 85", "90 < x < 85 is never true: write 85 < x < 90"),
        "every number": (
            "x < 90 or x > 85",
            "x < 90 or x > 85 is always true: write and instead of or",
        ),
        "two texts": (
            "c == 'red' and c == 'blue'",
            "c == 'red' and c == 'blue' is never true: write or instead of and",
        ),
        "no text": (
            "c != 'red' or c != 'blue'",
            "c != 'red' or c != 'blue' is always true: write and instead of or",
        ),
        "negated": (
            "not c == 'red' or not c == 'blue'",
            "not c == 'red' or not c == 'blue' is always true: write and instead of or",
        ),
        "a negated pair": (
            "not (c == 'red' and c == 'blue')",
            "c == 'red' and c == 'blue' is never true: write or instead of and",
        ),
        "a part": (
            "go and (c == 1 and c == 2)",
            "c == 1 and c == 2 is never true: write or instead of and",
        ),
        "among others": (
            "go and c == 1 and c == 2",
            "c == 1 and c == 2 is never true: write or instead of and",
        ),
        "colours of Pybricks": (
            "eye.color() == Color.RED and eye.color() == Color.BLUE",
            "eye.color() == Color.RED and eye.color() == Color.BLUE is never true: write or instead of and",
        ),
        "names of numbers": (
            "HIGH < x < LOW",
            "HIGH < x < LOW is never true: write 5 < x < 9",
        ),
        "a text alone": (
            "c == 'red' or 'blue'",
            "'blue' alone is true, so this is always true: write or c == 'blue'",
        ),
        "a text alone after and": (
            "c != 'red' and 'blue'",
            "'blue' alone is true, and changes nothing: write and c != 'blue'",
        ),
        "a number alone": (
            "c == 5 or 2",
            "2 alone is true, so this is always true: write or c == 2",
        ),
        "a name alone": (
            "c == Color.RED or Color.BLUE",
            "Color.BLUE alone is true, so this is always true: write or c == Color.BLUE",
        ),
        "a choice of texts": (
            "c == ('red' or 'blue')",
            "'red' or 'blue' is only 'red': write c in ('red', 'blue')",
        ),
    },
)
def test_a_condition_that_is_always_the_same_is_told_with_its_cure(test: str, words: str) -> None:
    assert list_texts(f"HIGH = 9\nLOW = 5\nwhile {test}:\n    go()\n") == [words]


@for_rows(
    "test",
    {
        "a span": "5 < x < 9",
        "a span of one number": "4 < x < 5",
        "outside": "x < 5 or x > 9",
        "two values": "x < 5 and y > 9",
        "another sensor": "left.color == 1 and right.color == 2",
        "another item": "rgb[0] < 5 and rgb[1] > 9",
        "neither": "c != 'red' and c != 'blue'",
        "either": "c == 'red' or c == 'blue'",
        "other readings": "read() == 1 and read() == 2",
        "the next items": "next(it) == 1 and next(it) == 2",
        "assigned between": "(x := f()) < 5 and (x := f()) > 9",
        "changed between": "x < 5 and turn() and x > 9",
        "at the limit": "x >= 5 and x <= 5",
        "a switch": "x == 5 or 1",
        "on or off": "x == 1 or True",
        "another kind": "c == 'red' or 5",
        "a default": "(name or 'red') == 'red'",
        "an unknown limit": "x < low and x > high",
        "counted": "n < 5 and n % 2 == 0 and n % 2 != 1",
    },
)
def test_a_condition_that_can_be_true_and_false_is_not_blamed(test: str) -> None:
    assert list_texts(f"while {test}:\n    go()\n") == []


def test_the_old_form_of_a_choice_and_the_text_of_a_failed_check_are_no_conditions() -> None:
    assert list_texts("x = c == 'red' and 'stop' or 'go'\n") == []
    assert list_texts("def check(n):\n    return n == 'red' or 'no colour'\n") == []


@cases(
    "branches, words",
    {
        "a narrower one": (
            ("x < 80", "x < 10"),
            ["this is never reached: if x < 10, then also x < 80 (line 1); ask the narrower question first"],
        ),
        "the same": (
            ("x == 1", "x == 2", "x == 1"),
            ["this is never reached: line 1 asks the same"],
        ),
        "the wider one last": (("x < 10", "x < 80"), []),
        "neighbours": (("x < 10", "x >= 10"), []),
        "values": (("x == 1", "x == 2", "x != 3"), []),
        "another value": (("x < 80", "y < 10"), []),
        "with something else": (("x < 80 and go", "x < 10"), []),
    },
)  # fmt: skip
def test_a_branch_that_is_never_reached_is_told(
    branches: tuple[str, ...], words: list[str]
) -> None:
    first, *others = branches
    text = f"if {first}:\n    a()\n"
    for number, test in enumerate(others):
        text += f"elif {test}:\n    b{number}()\n"
    assert list_texts(text) == words


def test_a_condition_of_thousands_of_parts_takes_no_time() -> None:
    tests = " or ".join(f"x == {number}" for number in range(1000))
    branches = "".join(f"elif x == {number}:\n    b{number}()\n" for number in range(1000))
    assert list_texts(f"if {tests}:\n    a()\n{branches}") == []


READS = (
    "left = colorLeft.reflected_light_intensity_pc\n"
    "right = colorRight.reflected_light_intensity_pc\n"
)


@cases(
    "text, words",
    {
        "a reading": (
            f"{READS}while left and right > 6:\n    go()\n",
            ["left alone is no comparison, and mostly true: write left > 6"],
        ),
        "a sensor": (
            "while colorLeft and colorRight.color > 6:\n    go()\n",
            ["colorLeft alone is no comparison, and mostly true: write colorLeft.color > 6"],
        ),
        "a sensor that may be missing": (
            "eye = None\neye = ColorSensor()\nif eye and gyro.angle > 6:\n    go()\n",
            [],
        ),
        "the same sensor": ("eye = ColorSensor()\nif eye and eye.color > 6:\n    go()\n", []),
        "a flag": (f"{READS}left = True\nif left and right > 6:\n    go()\n", []),
        "another kind": (f"{READS}deg = gyro.angle\nif deg and right > 6:\n    go()\n", []),
        "a parameter": ("def f(gyro):\n    if gyro and colorLeft.color > 6:\n        go()\n", []),
    },
)  # fmt: skip
def test_a_sensor_beside_the_comparison_of_another_one_is_told(text: str, words: list[str]) -> None:
    assert list_texts(text) == words
