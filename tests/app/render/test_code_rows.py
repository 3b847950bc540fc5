"""A program in a narrow column: its rows fit, and are the same program."""

from __future__ import annotations

import ast

from tests.cases import for_each, for_rows
from tuisim.app.render.code_rows import split_rows
from tuisim.tasks.lessons.catalogue import find_shipped_paths
from tuisim.tasks.lessons.files import load_lesson

ANSWERS = {name: load_lesson(path).model_answer for name, path in find_shipped_paths().items()}
PROGRAMS = {
    "brackets": (
        "tank_drive.on_for_rotations(SpeedPercent(30), SpeedPercent(30), 5.7)\n",
        ["tank_drive.on_for_rotations(", "  SpeedPercent(30),", "  SpeedPercent(30), 5.7)"],
    ),
    "comment": (
        "WHEEL_MM = 3.14159 * 56  # one rotation of it\n",
        ["# one rotation of it", "WHEEL_MM = 3.14159 * 56"],
    ),
    "long comment": (
        "    # one two three four five six\n",
        ["    # one two three four five", "    # six"],
    ),
    "no brackets": (
        "if first_one and second_one or third:\n",
        ["if first_one and second_one \\", "  or third:"],
    ),
    "no other place than a dot": (
        "light = colorLeft.reflected_light_in_pc\n",
        ["light = \\", "  colorLeft \\", "  .reflected_light_in_pc"],
    ),
    "no blank": (
        "a_name_that_is_longer_than_the_column = 1\n",
        ["a_name_that_is_longer_than_the_column \\", "  = 1"],
    ),
    "in a text": (
        'x = f"one two three {four} five six"\n',
        ["x = \\", '  f"one two three {four} five six"'],
    ),
    "not Python": (
        "print('one two three four five six seven\n",
        ["print('one two three four five six seven"],
    ),
}


@for_rows("program, rows", PROGRAMS)
def test_long_lines_are_broken_between_words(program: str, rows: list[str]) -> None:
    assert list(split_rows(program, 30)) == rows


@for_each(name=ANSWERS)
def test_rows_of_a_model_answer_are_the_same_program(name: str) -> None:
    for width in (38, 43, 56):
        rows = list(split_rows(ANSWERS[name], width))
        assert ast.dump(ast.parse("\n".join(rows))) == ast.dump(ast.parse(ANSWERS[name]))
        assert [row for row in rows if len(row) > width and '"""' not in row] == []
