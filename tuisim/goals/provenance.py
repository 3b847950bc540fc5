"""Where what a program prints and does comes from: the lines that read sensors, and the lines that depend on them.

The text is not executed. Whatever may depend on a reading counts as depending on it: a value that is computed from one,
a variable that is set where a reading decides, and what follows a loop that a reading ends. Only a product with a
literal 0 depends on nothing.
"""

from __future__ import annotations

import ast
import math
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
READING_NAMES: Mapping[Reading, frozenset[str]] = {
    kind: frozenset(names.split()) for kind, names in _NAMES.items()
}
"""The attributes and methods that give a reading, whatever the object is called."""

_PRINTS = frozenset({"print", "say", "write"})
_KEEPS = frozenset(
    {"append", "appendleft", "extend", "insert", "add", "update", "put", "setdefault"}
)
"""Methods that put their arguments into the object."""
_PAUSES = (
    *(
        "sleep",
        "wait",
        "on_for",
        "run_to",
        "run_time",
        "run_angle",
        "run_target",
        "run_until",
        "drive_time",
    ),
    *("play", "speak", "beep"),
)
"""How the names begin of functions and methods that let time pass."""
_LEAVES = (ast.Break, ast.Continue, ast.Return, ast.Raise, ast.While)
_GIVES = (ast.Return, ast.Yield, ast.YieldFrom)
_Function = ast.FunctionDef | ast.AsyncFunctionDef


class _By(IntEnum):
    """What decides that a statement comes."""

    NOTHING = 0
    LOOP = 1
    """A reading begins, repeats or ends a loop around it or before it."""
    BRANCH = 2
    """A reading chooses it among others."""


class Provenance:
    """What depends on a kind of reading in the text of a program, whose lines stand for what they call in its modules.

    Args:
        text: The program.
        reading: The kind.
        modules: The texts of its own modules.

    Raises:
        SyntaxError, ValueError, RecursionError: the program is not Python.
    """

    def __init__(self, text: str, reading: Reading, modules: Sequence[str] = ()) -> None:
        self._wanted = READING_NAMES[reading]
        self._tree = ast.parse(text)
        self._modules = [tree for module in modules if (tree := _parsed(module))]
        functions = [
            node
            for tree in (*self._modules, self._tree)
            for node in ast.walk(tree)
            if isinstance(node, _Function)
        ]
        self._functions = {
            node.name: [one for one in functions if one.name == node.name] for node in functions
        }
        self._derived: set[str] = set()
        """Variables, attributes and functions whose value depends on a reading."""
        self._decided: set[str] = set()
        """Functions that are called where a reading decides."""
        self._deciding: set[str] = set()
        """Functions of modules in which a reading decides that something is printed."""
        self._found: list[tuple[ast.AST, bool, bool]] = []
        """Each simple statement, or head of another: does a reading give its value, does one decide that it comes?"""
        sets = (self._derived, self._decided, self._deciding)
        known: list[int] = []
        while known != (now := [len(one) for one in sets]):
            known = now
            for module in self._modules:
                self._found.clear()
                self._block(module.body, _By.NOTHING)
                self._note_prints(module)
            self._found.clear()
            self._block(self._tree.body, _By.NOTHING)

    def _note_prints(self, module: ast.Module) -> None:
        """Let the calls of a module's functions that print stand for what these print."""
        inside = [
            (one, set(map(id, ast.walk(one))))
            for one in ast.walk(module)
            if isinstance(one, _Function)
        ]
        for node, value, decided in self._found:
            called = {_called(call) for call in _calls(node)}
            names = {one.name for one, nodes in inside if id(node) in nodes}
            if value and called & (_PRINTS | self._derived):
                self._derived |= names
            if (decided and called & _PRINTS) or called & self._deciding:
                self._deciding |= names

    def lines(self) -> frozenset[int]:
        """Return the lines of the program that take such a reading, or call a function of a module that does."""
        takers = self._takers()
        nodes: list[ast.AST] = []
        for node in ast.walk(self._tree):
            match node:
                case ast.Attribute(attr=name) if name in self._wanted or name in takers:
                    nodes.append(node)
                case ast.Call() if _called(node) in takers:
                    nodes.append(node)
                # A generator goes on when its next value is asked for.
                case (
                    ast.For(iter=ast.Name() as part)
                    | ast.Call(func=ast.Name(id="next"), args=[part, *_])
                ):
                    if takers and self._is_derived(part):
                        nodes.append(part)
        return frozenset(line for node in nodes for line in _lines(node))

    def _takers(self) -> frozenset[str]:
        """Return the names of the functions of modules that take such a reading."""
        inside = []
        for one in (
            node
            for module in self._modules
            for node in ast.walk(module)
            if isinstance(node, _Function)
        ):
            attributes = {part.attr for part in ast.walk(one) if isinstance(part, ast.Attribute)}
            inside.append((one.name, attributes & self._wanted, attributes | _names(one)))
        found: frozenset[str] = frozenset()
        while more := {name for name, reads, used in inside if reads or used & found} - found:
            found |= more
        return found

    def pauses_s(self) -> dict[int, float]:
        """Return those of `lines` that also pause or drive: the time that passes in them is not that of readings.

        Returns:
            For each line for how long it pauses; infinity if the text does not say that in a number.
        """
        found: dict[int, float] = {}
        for node in ast.walk(self._tree):
            if isinstance(node, ast.Call) and _pauses(node):
                found[node.lineno] = found.get(node.lineno, 0.0) + _pause_s(node)
        lines = self.lines()
        return {line: pause_s for line, pause_s in found.items() if line in lines}

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
        found = [
            each
            for each in self._found
            if each[0].lineno <= line <= (each[0].end_lineno or 0)  # type: ignore[attr-defined]
        ]
        prints = [each for each in found if _PRINTS & {_called(call) for call in _calls(each[0])}]
        groups = _printed_together(prints)
        named = [
            group for group in groups if name and any(_says(node, name) for node, _, _ in group)
        ]
        return [
            (any(value for _, value, _ in group), any(decided for *_, decided in group))
            for group in named or groups or [[each] for each in found]
        ]

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
                blocks = [
                    node.body,
                    *(handler.body for handler in node.handlers),
                    node.orelse,
                    node.finalbody,
                ]
                return max(self._block(block, by) for block in blocks)
            case _:
                self._simple(node, by)
        return by

    def _branch(
        self, test: ast.expr, blocks: Iterable[Sequence[ast.stmt]], by: _By, *, loops: bool = False
    ) -> _By:
        depends = self._take(test, by)
        within = max(by, _By.LOOP if loops else _By.BRANCH) if depends else by
        after = [self._block(block, within) for block in blocks]
        if not depends:
            return max(after)
        leaves = any(
            isinstance(node, _LEAVES) for block in blocks for one in block for node in ast.walk(one)
        )
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
        if (value or by is _By.LOOP) and any(isinstance(part, _GIVES) for part in ast.walk(node)):
            functions = (one for same in self._functions.values() for one in same)
            self._derived |= {one.name for one in functions if node in ast.walk(one)}

    def _take(self, node: ast.AST, by: _By) -> bool:
        """Note a piece of the program, and what its calls pass on. Return whether its value depends on a reading."""
        value = any(map(self._is_derived, _parts_that_count(node)))
        decides = any(_called(call) in self._deciding for call in _calls(node))
        self._found.append((node, value, decides or by is not _By.NOTHING))
        for part in ast.walk(node):
            if isinstance(part, ast.NamedExpr) and any(map(self._is_derived, ast.walk(part.value))):
                self._assign(part.target)
        for call in _calls(node):
            self._call(call, by)
        return value

    def _call(self, call: ast.Call, by: _By) -> None:
        given = [*call.args, *(keyword.value for keyword in call.keywords)]
        derived = by is _By.BRANCH or any(
            self._is_derived(part) for one in given for part in ast.walk(one)
        )
        name = _called(call)
        if by is not _By.NOTHING:
            self._decided |= (
                {name} | {one.id for one in given if isinstance(one, ast.Name)}
            ) & set(self._functions)
        if derived and name in self._functions:
            for arguments in (one.args for one in self._functions[name]):
                self._derived |= {
                    one.arg
                    for one in (*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs)
                }
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


_Found = tuple[ast.AST, bool, bool]


def _printed_together(prints: Sequence[_Found]) -> list[list[_Found]]:
    """Return statements that print in groups, each of which ends its line."""
    groups: list[list[_Found]] = []
    goes_on = False
    for each in prints:
        if goes_on:
            groups[-1].append(each)
        else:
            groups.append([each])
        goes_on = any(keyword.arg == "end" for call in _calls(each[0]) for keyword in call.keywords)
    return groups


def _lines(node: ast.AST) -> range:
    """Return the lines of a statement or an expression."""
    return range(node.lineno, (node.end_lineno or node.lineno) + 1)  # type: ignore[attr-defined]


def _parsed(text: str) -> ast.Module | None:
    """Return the tree of a module; None if it is not Python: nothing of it can run."""
    try:
        return ast.parse(text)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return None


def _pause_s(call: ast.Call) -> float:
    """Return for how long a call pauses, infinity if it is not `sleep` or `wait` of a number."""
    match call.args:
        case [ast.Constant(value=int() | float() as number)] if number >= 0:
            return {"sleep": number, "wait": number / 1000}.get(_called(call), math.inf)
    return math.inf


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
def provenance_of(text: str, reading: Reading, modules: tuple[str, ...] = ()) -> Provenance | None:
    """Return what depends on a kind of reading in a program; None if the text is not Python."""
    try:
        return Provenance(text, reading, modules)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return None
