"""What names are bound to, scope by scope."""

from __future__ import annotations

import ast

from tuisim.config.program_robot.scopes import Bound, Defined, Imported, Parameter, Scope, scope_of
from tuisim.config.program_robot.source import read_modules
from tuisim.source import Program


def scope(text: str) -> Scope:
    (module,) = read_modules(Program("p.py", text)).values()
    return scope_of(module)


def inner(outer: Scope, name: str) -> Scope:
    return next(one for node, one in outer.inner.items() if getattr(node, "name", "") == name)


def test_each_kind_of_binding() -> None:
    names = scope("import os.path\nfrom a import b as c\nx = 1\ndef f(p):\n    pass\n").names
    assert names["os"] == [Imported("os")] and names["c"] == [Imported("a", "b")]
    assert [type(one) for name in ("x", "f") for one in names[name]] == [Bound, Defined]


def test_a_name_may_be_bound_more_than_once() -> None:
    found = scope("x = 1\nif x:\n    x = 2\nfor x in (3,):\n    pass\n").names["x"]
    assert [one.is_item for one in found if isinstance(one, Bound)] == [False, False, True]


def test_names_that_are_unpacked_have_their_place() -> None:
    names = scope("a, (b, c) = 1, (2, 3)").names
    assert [one.path for name in "abc" for one in names[name] if isinstance(one, Bound)] == [
        (0,),
        (1, 0),
        (1, 1),
    ]


def test_parameters_belong_to_the_function() -> None:
    top = scope("def f(p, *, q=1):\n    r = p\n")
    function = inner(top, "f")
    assert {name for name, (one, *_) in function.names.items() if isinstance(one, Parameter)} == {
        "p",
        "q",
    }
    assert "r" in function.names and "r" not in top.names
    assert function.top is top and function.owner is None


def test_what_a_function_declares_global_is_bound_outside() -> None:
    top = scope("def f():\n    global x\n    x = 1\n")
    assert "x" in top.names and "x" not in inner(top, "f").names


def test_what_methods_set_on_self_are_attributes_of_the_class() -> None:
    top = scope("class C:\n    def __init__(self):\n        self.m = 1\n")
    owner = inner(top, "C")
    assert isinstance(owner.node, ast.ClassDef)
    assert list(owner.attributes) == ["m"]
    assert inner(owner, "__init__").owner is owner


def test_all_names_of_a_module_may_be_imported() -> None:
    assert scope("from ev3dev2.motor import *\n").stars == ["ev3dev2.motor"]
