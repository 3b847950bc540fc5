"""The lines of a program that the brick's MicroPython refuses."""

from __future__ import annotations

import ast

from tests.cases import for_each, for_rows
from tuisim.programs.robot.brick_syntax import find_refused_lines
from tuisim.programs.robot.source import Module


def found(text: str) -> list[tuple[int, str]]:
    return [
        (one.line, one.what) for one in find_refused_lines([Module("", "p.py", ast.parse(text))])
    ]


@for_rows(
    "text, what",
    [
        ("print(f'{1:{2}d}')", "f-string"),
        ("if (n := 3): pass", "assignment in an expression, :="),
        ("match 1:\n    case _: pass", "match statement"),
        ("speed: int = 3", "annotation of a variable"),
        ("try: pass\nexcept* OSError: pass", "except*"),
        ("a @= b @ c", "operator @"),
        ("def f(a, /): pass", "positional-only parameters, /"),
        ("c = [*a, 1]", "* in a list, tuple or set"),
        ("return_ = *a, 1", "* in a list, tuple or set"),
        ("c = {*a}", "* in a list, tuple or set"),
        ("c = {**a}", "** in a dictionary"),
        ("f(*a, 1)", "something after * in a call"),
        ("f(*a, *b)", "something after * in a call"),
        ("import sys, time", "time"),
        ("from collections import namedtuple", "collections"),
        ("class A:\n    @property\n    def b(self): pass", "property"),
        ("open('log.txt')", "open"),
        ("import usys\nusys.exit()", "sys.exit"),
    ],
)
def test_a_line_that_the_bricks_python_would_refuse_is_found(text: str, what: str) -> None:
    assert {one for _, one in found(text)} == {what}


@for_each(
    text=[
        "a, *b = c",
        "[a, *b] = c",
        "print('{}'.format(1), '%d' % 2, b'' + rb'')",
        "f(1, *a, x=1, **b)",
        "def f(a: int, *b, c=1, **d) -> int: return lambda *x: x",
        "n = 1_000",
        "import sys\nsys.print_exception(error)\nrobot.exit()",
        "time = watch.time()\nwait(time)",
        "def open(): pass\nopen()\ngripper.open()",
        "async def f():\n    async with a: await b",
        "def f():\n    nonlocal_ = yield from g()",
    ]
)
def test_syntax_that_the_bricks_python_takes_is_not_refused(text: str) -> None:
    assert found(text) == []


def test_refused_lines_are_listed_in_order_with_their_file() -> None:
    modules = [
        Module("", "p.py", ast.parse("x = f''\n\ny: int = f''")),
        Module("m", "m.py", ast.parse("f''")),
    ]
    assert [str(one) for one in find_refused_lines(modules)] == [
        "p.py:1: the brick's Python would refuse this line (f-string)",
        "p.py:3: the brick's Python would refuse this line (annotation of a variable)",
        "p.py:3: the brick's Python would refuse this line (f-string)",
        "m.py:1: the brick's Python would refuse this line (f-string)",
    ]
