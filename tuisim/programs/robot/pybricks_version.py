"""Which version of Pybricks a program is for: the names that version 4 has, and version 2.0 has not."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator, Mapping

from tuisim.base.source import PYBRICKS, PYBRICKS_4_NAMES
from tuisim.programs.robot.course import find_definitions
from tuisim.programs.robot.source import Module

IMPORTS: Mapping[str, frozenset[str]] = {
    PYBRICKS: frozenset({"version"}),
    "pybricks.hubs": frozenset({"ThisHub"}),
    "pybricks.parameters": frozenset({"Axis", "Font", "Icon", "Image", "Side"}),
    "pybricks.robotics": frozenset({"Car", "GyroDriveBase", "SpikeBase"}),
    "pybricks.tools": frozenset({"Axis", "Matrix", "cross", "hub_menu", "multitask", "run_task"})
    | {"read_input_byte", "vector"},
}
"""Names of version 4, by the module that a program imports them from."""
MEMBERS: Mapping[str, frozenset[str]] = {
    "Stop": frozenset({"BRAKE_SMART", "COAST_SMART", "NONE"}),
    "Color": frozenset({"CYAN", "GRAY", "MAGENTA", "NONE", "VIOLET"}),
    "light": frozenset({"animate", "blink"}),
    "speaker": frozenset({"volume"}),
    "system": frozenset({"info", "name", "set_stop_button", "shutdown", "storage"}),
}
"""Members of version 4, by the class or the part of the hub."""
METHODS = frozenset({"arc", "curve", "move_by", "use_gyro"})
"""Methods of a drive base that only version 4 has."""
ARGUMENTS: Mapping[str, frozenset[str]] = {
    **dict.fromkeys(("straight", "turn"), frozenset({"absolute", "then", "wait"})),
    "Motor": frozenset({"profile", "reset_angle"}),
    "settings": frozenset({"max_voltage"}),
}
"""Arguments that only version 4 has, by the class or the method."""


def find_version_4_name(modules: Iterable[Module]) -> str:
    """Return a name in a program for Pybricks that only version 4 of it has; empty for none."""
    trees = [module.tree for module in modules]
    own = {name for tree in trees for name in find_definitions(tree)}
    names = (name for tree in trees for node in ast.walk(tree) for name in _list_names(node, own))
    return next(names, "")


def _list_names(node: ast.AST, own: set[str]) -> Iterator[str]:
    """Yield the names of version 4 of Pybricks in one node of a syntax tree.

    Args:
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
    """Yield the names of version 4 in a call of a function or method that the program does not define."""
    known = ARGUMENTS.get(name, frozenset())
    yield from (f"{keyword.arg}= of {name}()" for keyword in call.keywords if keyword.arg in known)
    if name == "Color" and len(call.args) > 1:
        yield "Color(h, s, v)"
    elif name in METHODS and isinstance(call.func, ast.Attribute):
        yield f"{name}()"
    elif name in ("straight", "turn") and len(call.args) > 1:
        yield f"then of {name}()"
