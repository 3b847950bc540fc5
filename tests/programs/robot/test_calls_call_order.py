"""Which lines of a program are reached first, by the calls that lead to them."""

from __future__ import annotations

import ast

from tests.cases import cases
from tuisim.base.source import Program
from tuisim.programs.robot.calls import CallOrder
from tuisim.programs.robot.mentions import read_mentions
from tuisim.programs.robot.source import read_modules

ORDERS = {
    "by lines": ("a()\nb()", "ab"),
    "by calls": ("def f():\n    a()\nb()\nf()", "ba"),
    "by the first of some calls": ("def f():\n    a()\nf()\nb()\nf()", "ab"),
    "by calls of calls": (
        "def f():\n    a()\ndef g():\n    f()\ndef h():\n    b()\nh()\ng()",
        "ba",
    ),
    "in an object": ("class C:\n    def f(self):\n        a()\nc = C()\nb()\nc.f()", "ba"),
    "when an object is made": ("class C:\n    def __init__(self):\n        a()\nC()\nb()", "ab"),
    "without a known call": ("def f():\n    a()\nrun(f)\nb()", "ba"),
    "otherwise only by itself": ("def f():\n    f()\n    a()\nrun(f)\nb()", "ba"),
}


@cases("text, order", ORDERS)
def test_lines_of_a_program_are_ordered_as_its_functions_are_called(text: str, order: str) -> None:
    program = Program("p.py", "from ev3dev2.motor import *\n" + text)
    mentions = read_mentions(read_modules(program))
    assert mentions.evaluation is not None
    calls = CallOrder(mentions.evaluation.calls)
    orders = {
        node.func.id: calls.find_order(node.lineno, scope)
        for scope in mentions.scopes
        for node in scope.body
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in "ab"
    }
    assert "".join(sorted(orders, key=orders.__getitem__)) == order


def test_ordering_deeply_nested_calls_is_quick() -> None:
    lines = "".join(f"def f{n}():\n    f{n + 1}()\n    f{n + 1}()\n" for n in range(60))
    program = Program("p.py", f"from ev3dev2.motor import *\n{lines}def f60():\n    a()\nf0()\n")
    mentions = read_mentions(read_modules(program))
    assert mentions.evaluation is not None
    (scope,) = (one for one in mentions.scopes if getattr(one.node, "name", "") == "f60")
    order = CallOrder(mentions.evaluation.calls).find_order(1, scope)
    assert len(order) == 62
