"""Where what a program prints and does comes from: the lines that read sensors, and the lines that depend on them.

The text is not executed. Whatever may depend on a reading counts as depending on it: a value that is computed from one,
a variable that is set where a reading decides, and what follows a loop that a reading ends.
"""

from __future__ import annotations

import ast
from collections.abc import Iterable, Mapping, Sequence
from functools import lru_cache

from tuisim.goals.spec import Reading

_ANY_SENSOR = "value bin_data"
_NAMES: Mapping[Reading, str] = {
    Reading.COLOR: "reflected_light_intensity reflected_light_intensity_pc full_reflected_light_intensity color "
    f"color_name ambient_light_intensity raw rgb lab hsv hls red green blue reflection ambient {_ANY_SENSOR}",
    Reading.ULTRASONIC: "distance_centimeters distance_centimeters_continuous distance_centimeters_ping distance "
    f"distance_inches distance_inches_continuous distance_inches_ping {_ANY_SENSOR}",
    Reading.GYRO: f"angle rate angle_and_rate circle_angle speed {_ANY_SENSOR}",
    Reading.MOTOR: "position rotations degrees speed angle distance",
}
READING_NAMES: Mapping[Reading, frozenset[str]] = {kind: frozenset(names.split()) for kind, names in _NAMES.items()}
"""The attributes and methods that give a reading, whatever the object is called."""

_PRINTS = frozenset({"print", "say", "write"})
_KEEPS = frozenset({"append", "appendleft", "extend", "insert", "add", "update", "put", "setdefault"})
"""Methods that put their arguments into the object."""
_LEAVES = (ast.Break, ast.Continue, ast.Return, ast.Raise, ast.While)
_Function = ast.FunctionDef | ast.AsyncFunctionDef


class Provenance:
    """What depends on a kind of reading in the text of a program.

    Args:
        text: The program.
        reading: The kind.

    Raises:
        SyntaxError, ValueError, RecursionError: the program is not Python.
    """

    def __init__(self, text: str, reading: Reading) -> None:
        self._wanted = READING_NAMES[reading]
        self._tree = ast.parse(text)
        self._functions = {node.name: node for node in ast.walk(self._tree) if isinstance(node, _Function)}
        self._derived: set[str] = set()
        """Variables, attributes and functions whose value depends on a reading."""
        self._decided: set[str] = set()
        """Functions that are called where a reading decides."""
        self._found: list[tuple[ast.AST, bool, bool]] = []
        """Each simple statement, or head of another: does a reading give its value, does one decide that it comes?"""
        known = (-1, -1)
        while known != (len(self._derived), len(self._decided)):
            known = (len(self._derived), len(self._decided))
            self._found.clear()
            self._block(self._tree.body, decided=False)

    def lines(self) -> frozenset[int]:
        """Return the lines of the program that take such a reading."""
        nodes = (node for node in ast.walk(self._tree) if isinstance(node, ast.Attribute) and node.attr in self._wanted)
        return frozenset(line for node in nodes for line in range(node.lineno, (node.end_lineno or node.lineno) + 1))

    def gives(self, line: int) -> bool:
        """Return whether what a line prints is computed from a reading; also if the line is not known."""
        return all(value for value, _ in self._printed_at(line))

    def decides(self, line: int) -> bool:
        """Return whether a reading decides that a line comes, or what it does; also if the line is not known."""
        return all(value or decided for value, decided in self._printed_at(line))

    def _printed_at(self, line: int) -> list[tuple[bool, bool]]:
        found = [each for each in self._found if each[0].lineno <= line <= (each[0].end_lineno or 0)]  # type: ignore[attr-defined]
        prints = [each for each in found if _PRINTS & {_called(call) for call in _calls(each[0])}]
        return [(value, decided) for _, value, decided in prints or found]

    # Walking

    def _block(self, body: Sequence[ast.stmt], *, decided: bool) -> bool:
        """Take in statements. Return whether a reading decides what comes after them."""
        for statement in body:
            decided = self._statement(statement, decided)
        return decided

    def _statement(self, node: ast.stmt, decided: bool) -> bool:
        match node:
            case ast.FunctionDef() | ast.AsyncFunctionDef():
                self._block(node.body, decided=node.name in self._decided)
                return decided
            case ast.ClassDef():
                self._block(node.body, decided=decided)
                return decided
            case ast.If() | ast.While():
                return self._branch(node.test, [node.body, node.orelse], decided, loops=isinstance(node, ast.While))
            case ast.For() | ast.AsyncFor():
                if decided or any(map(self._is_derived, ast.walk(node.iter))):
                    self._assign(node.target)
                return self._branch(node.iter, [node.body, node.orelse], decided)
            case ast.Match():
                return self._branch(node.subject, [case.body for case in node.cases], decided)
            case ast.With() | ast.AsyncWith():
                for item in node.items:
                    self._take(item.context_expr, item.context_expr, decided)
                return self._block(node.body, decided=decided)
            case ast.Try() | ast.TryStar():
                blocks = [node.body, *(handler.body for handler in node.handlers), node.orelse, node.finalbody]
                after = [self._block(block, decided=decided) for block in blocks]
                return any(after)
            case _:
                self._simple(node, decided)
                return decided

    def _branch(
        self, test: ast.expr, blocks: Iterable[Sequence[ast.stmt]], decided: bool, *, loops: bool = False
    ) -> bool:
        depends = self._take(test, test, decided)
        inner = [self._block(block, decided=decided or depends) for block in blocks]
        if decided or not depends:
            return any(inner)
        return loops or any(isinstance(node, _LEAVES) for block in blocks for one in block for node in ast.walk(one))

    def _simple(self, node: ast.stmt, decided: bool) -> None:
        value = self._take(node, node, decided) or decided
        match node:
            case ast.Assign(targets=targets) if value:
                for target in targets:
                    self._assign(target)
            case ast.AugAssign(target=target) | ast.AnnAssign(target=target) if value:
                self._assign(target)
            case ast.Return() if value:
                self._derived |= {name for name, one in self._functions.items() if node in ast.walk(one)}

    def _take(self, node: ast.AST, where: ast.AST, decided: bool) -> bool:
        """Note a piece of the program, and what its calls pass on. Return whether its value depends on a reading."""
        value = any(self._is_derived(part) for part in ast.walk(node))
        self._found.append((where, value, decided))
        for part in ast.walk(node):
            if isinstance(part, ast.NamedExpr) and (decided or any(map(self._is_derived, ast.walk(part.value)))):
                self._assign(part.target)
        for call in _calls(node):
            self._call(call, decided)
        return value

    def _call(self, call: ast.Call, decided: bool) -> None:
        given = [*call.args, *(keyword.value for keyword in call.keywords)]
        derived = decided or any(self._is_derived(part) for one in given for part in ast.walk(one))
        name = _called(call)
        if decided:
            self._decided |= {name} | {one.id for one in given if isinstance(one, ast.Name)} & set(self._functions)
        if derived and name in self._functions:
            arguments = self._functions[name].args
            self._derived |= {one.arg for one in (*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs)}
        if derived and name in _KEEPS and isinstance(call.func, ast.Attribute):
            self._assign(call.func.value)

    def _is_derived(self, node: ast.AST) -> bool:
        match node:
            case ast.Name(id=name):
                return name in self._derived
            case ast.Attribute(attr=attr):
                return attr in self._wanted or attr in self._derived
        return False

    def _assign(self, target: ast.AST) -> None:
        match target:
            case ast.Name(id=name) | ast.Attribute(attr=name):
                self._derived.add(name)
            case ast.Tuple(elts=parts) | ast.List(elts=parts):
                for part in parts:
                    self._assign(part)
            case ast.Starred(value=value) | ast.Subscript(value=value):
                self._assign(value)


def _calls(node: ast.AST) -> list[ast.Call]:
    return [part for part in ast.walk(node) if isinstance(part, ast.Call)]


def _called(call: ast.Call) -> str:
    """Return the name of the function or method that is called, without what it belongs to."""
    match call.func:
        case ast.Name(id=name) | ast.Attribute(attr=name):
            return name
    return ""


@lru_cache(maxsize=16)
def provenance_of(text: str, reading: Reading) -> Provenance | None:
    """Return what depends on a kind of reading in a program; None if the text is not Python."""
    try:
        return Provenance(text, reading)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return None
