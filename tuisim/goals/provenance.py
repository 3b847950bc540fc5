"""Where what a program prints and does comes from: the lines that read sensors, and the lines that depend on them.

The text is not executed. Whatever may depend on a reading counts as depending on it: a value that is computed from one,
a variable that is set where a reading decides, and what follows a loop that a reading ends. Only a product with a
literal 0 depends on nothing.
"""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator, Mapping, Sequence
from enum import IntEnum
from functools import lru_cache

from tuisim.goals.spec import Reading

_ANY_SENSOR = "value bin_data"
_NAMES: Mapping[Reading, str] = {
    Reading.COLOR: "reflected_light_intensity reflected_light_intensity_pc full_reflected_light_intensity color "
    f"color_name ambient_light_intensity raw rgb lab hsv hls red green blue reflection ambient {_ANY_SENSOR}",
    Reading.ULTRASONIC: "distance_centimeters distance_centimeters_continuous distance_centimeters_ping distance "
    f"distance_inches distance_inches_continuous distance_inches_ping {_ANY_SENSOR}",
    Reading.GYRO: f"angle rate angle_and_rate circle_angle speed {_ANY_SENSOR}",
    Reading.MOTOR: "position rotations degrees speed angle distance state run_until_stalled",
}
READING_NAMES: Mapping[Reading, frozenset[str]] = {kind: frozenset(names.split()) for kind, names in _NAMES.items()}
"""The attributes and methods that give a reading, whatever the object is called."""

_PRINTS = frozenset({"print", "say", "write"})
_KEEPS = frozenset({"append", "appendleft", "extend", "insert", "add", "update", "put", "setdefault"})
"""Methods that put their arguments into the object."""
_PAUSES = (
    *("sleep", "wait", "on_for", "run_to", "run_time", "run_angle", "run_target", "run_until", "drive_time"),
    *("play", "speak", "beep"),
)
"""How the names begin of functions and methods that let time pass."""
_LEAVES = (ast.Break, ast.Continue, ast.Return, ast.Raise, ast.While)
_Function = ast.FunctionDef | ast.AsyncFunctionDef


class _By(IntEnum):
    """What decides that a statement comes."""

    NOTHING = 0
    LOOP = 1
    """A reading begins, repeats or ends a loop around it or before it."""
    BRANCH = 2
    """A reading chooses it among others."""


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
            self._block(self._tree.body, _By.NOTHING)

    def lines(self) -> frozenset[int]:
        """Return the lines of the program that take such a reading."""
        nodes = (node for node in ast.walk(self._tree) if isinstance(node, ast.Attribute) and node.attr in self._wanted)
        return frozenset(line for node in nodes for line in range(node.lineno, (node.end_lineno or node.lineno) + 1))

    def pausing_lines(self) -> frozenset[int]:
        """Return those of `lines` that also pause or drive: the time that passes in them is not that of readings."""
        pauses = [node.lineno for node in ast.walk(self._tree) if isinstance(node, ast.Call) and _pauses(node)]
        return self.lines() & frozenset(pauses)

    def gives(self, line: int, name: str = "") -> bool:
        """Return whether what a line prints is computed from a reading; also if the line is not known.

        Args:
            line: Its number.
            name: What is printed with the value, if the line also prints something else.
        """
        return all(value for value, _ in self._printed_at(line, name))

    def decides(self, line: int) -> bool:
        """Return whether a reading decides that a line comes, or what it does; also if the line is not known."""
        return all(value or decided for value, decided in self._printed_at(line))

    def _printed_at(self, line: int, name: str = "") -> list[tuple[bool, bool]]:
        found = [each for each in self._found if each[0].lineno <= line <= (each[0].end_lineno or 0)]  # type: ignore[attr-defined]
        prints = [each for each in found if _PRINTS & {_called(call) for call in _calls(each[0])}]
        named = [each for each in prints if name and _says(each[0], name)]
        return [(value, decided) for _, value, decided in named or prints or found]

    # Walking

    def _block(self, body: Sequence[ast.stmt], by: _By) -> _By:
        """Take in statements. Return what decides that something comes after them."""
        for statement in body:
            by = self._statement(statement, by)
        return by

    def _statement(self, node: ast.stmt, by: _By) -> _By:
        match node:
            case ast.FunctionDef() | ast.AsyncFunctionDef():
                self._block(node.body, _By.BRANCH if node.name in self._decided else _By.NOTHING)
            case ast.ClassDef():
                self._block(node.body, by)
            case ast.If():
                return self._branch(node.test, [node.body, node.orelse], by)
            case ast.While():
                return self._branch(node.test, [node.body, node.orelse], by, loops=True)
            case ast.For() | ast.AsyncFor():
                if by is _By.BRANCH or any(map(self._is_derived, ast.walk(node.iter))):
                    self._assign(node.target)
                return self._branch(node.iter, [node.body, node.orelse], by)
            case ast.Match():
                return self._branch(node.subject, [case.body for case in node.cases], by)
            case ast.With() | ast.AsyncWith():
                for item in node.items:
                    self._take(item.context_expr, by)
                return self._block(node.body, by)
            case ast.Try() | ast.TryStar():
                blocks = [node.body, *(handler.body for handler in node.handlers), node.orelse, node.finalbody]
                return max(self._block(block, by) for block in blocks)
            case _:
                self._simple(node, by)
        return by

    def _branch(self, test: ast.expr, blocks: Iterable[Sequence[ast.stmt]], by: _By, *, loops: bool = False) -> _By:
        depends = self._take(test, by)
        within = max(by, _By.LOOP if loops else _By.BRANCH) if depends else by
        after = [self._block(block, within) for block in blocks]
        if not depends:
            return max(after)
        leaves = any(isinstance(node, _LEAVES) for block in blocks for one in block for node in ast.walk(one))
        return max(by, _By.LOOP) if loops or leaves else by

    def _simple(self, node: ast.stmt, by: _By) -> None:
        value = self._take(node, by) or by is _By.BRANCH
        match node:
            case ast.Assign(targets=targets):
                for target in targets:
                    # What is counted in a loop depends on how long that goes on.
                    if value or (by is _By.LOOP and _names(target) & _names(node.value)):
                        self._assign(target)
            case ast.AugAssign(target=target) if value or by is _By.LOOP:
                self._assign(target)
            case ast.AnnAssign(target=target) if value:
                self._assign(target)
            case ast.Return() if value or by is _By.LOOP:
                self._derived |= {name for name, one in self._functions.items() if node in ast.walk(one)}

    def _take(self, node: ast.AST, by: _By) -> bool:
        """Note a piece of the program, and what its calls pass on. Return whether its value depends on a reading."""
        value = any(map(self._is_derived, _parts_that_count(node)))
        self._found.append((node, value, by is not _By.NOTHING))
        for part in ast.walk(node):
            if isinstance(part, ast.NamedExpr) and any(map(self._is_derived, ast.walk(part.value))):
                self._assign(part.target)
        for call in _calls(node):
            self._call(call, by)
        return value

    def _call(self, call: ast.Call, by: _By) -> None:
        given = [*call.args, *(keyword.value for keyword in call.keywords)]
        derived = by is _By.BRANCH or any(self._is_derived(part) for one in given for part in ast.walk(one))
        name = _called(call)
        if by is not _By.NOTHING:
            self._decided |= ({name} | {one.id for one in given if isinstance(one, ast.Name)}) & set(self._functions)
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


def _parts_that_count(node: ast.AST) -> Iterator[ast.AST]:
    """Yield what the value of a node may depend on: not the factors of a product with a literal 0."""
    # Not recursive: expressions may be deep.
    open_parts = [node]
    while open_parts:
        part = open_parts.pop()
        yield part
        if not _is_zero(part):
            open_parts.extend(ast.iter_child_nodes(part))


def _is_zero(node: ast.AST) -> bool:
    match node:
        case ast.BinOp(op=ast.Mult(), left=left, right=right):
            return any(isinstance(one, ast.Constant) and one.value == 0 for one in (left, right))
    return False


def _names(node: ast.AST) -> set[str]:
    return {part.id for part in ast.walk(node) if isinstance(part, ast.Name)}


def _calls(node: ast.AST) -> list[ast.Call]:
    return [part for part in ast.walk(node) if isinstance(part, ast.Call)]


def _says(node: ast.AST, name: str) -> bool:
    """Return whether a name is in a text in a piece of the program."""
    texts = (part.value for part in ast.walk(node) if isinstance(part, ast.Constant))
    return any(isinstance(text, str) and name in text for text in texts)


def _pauses(call: ast.Call) -> bool:
    """Return whether a call lets time pass besides readings, by its name."""
    # As functions, these may be a program's own; `say` of the course does not wait.
    if isinstance(call.func, ast.Attribute) and call.func.attr in ("straight", "turn", "say"):
        return True
    return _called(call).startswith(_PAUSES)


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
