"""Which version of Pybricks a program is for: the names that version 4 has, and version 2.0 has not."""

from __future__ import annotations

import ast
from collections.abc import Collection, Iterable, Iterator, Mapping

from tuisim.base.source import PYBRICKS, PYBRICKS_4_NAMES
from tuisim.programs.robot.course import find_definitions
from tuisim.programs.robot.source import Module

IMPORTS: Mapping[str, Collection[str]] = {
    PYBRICKS: ["version"],
    "pybricks.hubs": ["ThisHub"],
    "pybricks.parameters": ["Axis", "Font", "Icon", "Image", "Side"],
    "pybricks.robotics": ["Car", "GyroDriveBase", "SpikeBase"],
    "pybricks.tools": [
        "Axis",
        "Matrix",
        "cross",
        "hub_menu",
        "multitask",
        "read_input_byte",
        "run_task",
        "vector",
    ],
}
"""Names of version 4, by the module that a program imports them from."""
MEMBERS: Mapping[str, Collection[str]] = {
    "Stop": ["BRAKE_SMART", "COAST_SMART", "NONE"],
    "Color": ["CYAN", "GRAY", "MAGENTA", "NONE", "VIOLET"],
    "light": ["animate", "blink"],
    "speaker": ["volume"],
    "system": ["info", "name", "set_stop_button", "shutdown", "storage"],
}
"""Members of version 4, by the class or the part of the hub."""
METHODS = "arc", "curve", "move_by", "use_gyro"
"""Methods of a drive base that only version 4 has."""
ARGUMENTS: Mapping[str, Collection[str]] = {
    **dict.fromkeys(("straight", "turn"), ("absolute", "then", "wait")),
    "Motor": ["profile", "reset_angle"],
    "settings": ["max_voltage"],
}
"""Arguments that only version 4 has, by the class or the method."""


def find_version_4_name(modules: Iterable[Module]) -> str:
    """Return a name that a Pybricks program uses and only version 4 has; empty if it uses none."""
    trees = [module.tree for module in modules]
    own = {name for tree in trees for name in find_definitions(tree)}
    names = (name for tree in trees for node in ast.walk(tree) for name in _list_names(node, own))
    return next(names, "")


def _list_names(node: ast.AST, own: set[str]) -> Iterator[str]:
    """Yield those names in one node of a syntax tree that only version 4 of Pybricks has.

    Args:
        node: The node.
        own: The names that the program defines itself.
    """
    match node:
        case ast.ImportFrom(module=str(module), level=0, names=names):
            yield from (alias.name for alias in names if alias.name in IMPORTS.get(module, ()))
        case ast.Name(id=name) | ast.Attribute(attr=name) if name in PYBRICKS_4_NAMES - own:
            yield name
        case ast.Attribute(value=ast.Name(id=part) | ast.Attribute(attr=part), attr=name):
            if name in MEMBERS.get(part, ()) and not own & {part, name}:
                yield f"{part}.{name}"
        case ast.Call(func=ast.Attribute(attr=name) | ast.Name(id=name)) if name not in own:
            yield from _list_call_names(node, name)


def _list_call_names(call: ast.Call, name: str) -> Iterator[str]:
    """Yield the names of Pybricks 4 in a call of a function or method that the program does not define."""
    known = ARGUMENTS.get(name, ())
    yield from (f"{keyword.arg}= of {name}()" for keyword in call.keywords if keyword.arg in known)
    if name == "Color" and len(call.args) > 1:
        yield "Color(h, s, v)"
    elif name in METHODS and isinstance(call.func, ast.Attribute):
        yield f"{name}()"
    elif name in ("straight", "turn") and len(call.args) > 1:
        yield f"then of {name}()"
