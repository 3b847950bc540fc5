"""The intentions of a program that its comments, prints and names tell, and the lines that should carry them out."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable, Iterator, Sequence
from functools import cached_property
from itertools import pairwise

from tuisim.base.data_class import dataclass
from tuisim.base.source import source_lines
from tuisim.programs.moves import name_call
from tuisim.programs.robot.words import is_forwards
from tuisim.programs.waits import list_blocks

_MAGIC = "sim_magic"
"""Lines with this set up the run: their names, such as those of mats, say nothing about the program."""
_COLORS = {
    "black": re.compile(r"\b(black|schwarz\w*|noir|negro)\b", re.IGNORECASE),
    "white": re.compile(r"\b(white|weiß\w*|weiss\w*|blanc|blanco)\b", re.IGNORECASE),
}
_OTHERS = re.compile(
    r"\b(gr[ea]y\w*|grau\w*|gris|not|no|nicht|kein\w*|before|first|next|vor|edge|between)\b",
    re.IGNORECASE,
)
"""Words with which a remark is not, or not only, about a black or white band."""
_ANY_BAND = re.compile(
    r"\b(black|white|gr[ea]y|dark|band|line|schwarz|weiß|grau|linie)\b", re.IGNORECASE
)
_BEYOND = re.compile(
    r"\b(over|behind|past|beyond|across|after|further|more|other|onto|leave|off the|hinter|über|weiter)\b",
    re.IGNORECASE,
)
"""Words of a program that is to drive on after a band."""
_AROUND_LINES = 8
_STRAIGHT = re.compile(r"\bstraight\b", re.IGNORECASE)
_TURNS = re.compile(r"turn|spin|rotat|dance|circle|dreh|kreis|around", re.IGNORECASE)
_BEFORE_LINES = 4
_AFTER_LINES = 3
"""A remark is about a loop if it is so near to it."""


class Remarks:
    """The lines of a program, in which comments, prints and names tell its intentions.

    Args:
        text: The program.
        tree: Its syntax tree.
    """

    def __init__(self, text: str, tree: ast.Module) -> None:
        self._lines = source_lines(text)
        self._tree = tree

    @cached_property
    def spins(self) -> tuple[Spin, ...]:
        """The moves of both wheels in opposite directions that should drive the robot straight on."""
        return tuple(_list_spins(self._tree, self))

    @cached_property
    def wrong_units(self) -> tuple[WrongUnit, ...]:
        """The calls whose numbers are probably meant in another unit or in another order."""
        return tuple(_list_wrong_units(self._tree, self))

    @cached_property
    def late_stops(self) -> tuple[tuple[int, int, int], ...]:
        """The line numbers of loop, sleep and stop, for each loop up to a band that a sleep and a stop follow."""
        return tuple(_list_late_stops(self._tree, self))

    def find_color(self, first_line: int, last_line: int, others: Iterable[int] = ()) -> str:
        """Return `black` or `white` if the lines in and around a loop name only this colour; empty otherwise.

        Args:
            first_line: The first line of the loop.
            last_line: The last line of the loop.
            others: The first and last lines of other loops, at which the search for colours ends.
        """
        others = [*others]
        start = max([line + 1 for line in others if line < first_line], default=0)
        end = min([line for line in others if line > last_line], default=len(self._lines) + 1)
        first_line = max(start, first_line - _BEFORE_LINES)
        lines = self._list_lines(first_line, min(end - 1, last_line + _AFTER_LINES))
        text = " ".join(lines)
        colors = [name for name, words in _COLORS.items() if words.search(text)]
        return colors[0] if len(colors) == 1 and not _OTHERS.search(text) else ""

    def names_band(self, first_line: int, last_line: int) -> bool:
        """Return whether some lines name a band of the mat.

        The result is False if these lines, or those around them, also say that the robot drives on beyond the band.
        """
        around = self._list_lines(first_line - _AROUND_LINES, last_line + 1)
        is_beyond = _BEYOND.search(" ".join(around))
        text = " ".join(self._list_lines(first_line, last_line))
        return bool(_ANY_BAND.search(text)) and not is_beyond

    def goes_straight(self, line: int) -> bool:
        """Return whether a line, or a comment above it, says that the robot drives straight on."""
        above = [each for each in self._list_lines(line - 1, line - 1) if each.strip()[:1] == "#"]
        text = " ".join([*above, *self._list_lines(line, line)])
        return (is_forwards(text) or bool(_STRAIGHT.search(text))) and not _TURNS.search(text)

    def has_centimetres(self, line: int, number: int) -> bool:
        """Return whether a line, or the line above it, contains this number with the unit cm."""
        text = " ".join(self._list_lines(line - 1, line))
        return bool(number) and bool(re.search(rf"\b{number}\b\W{{0,6}}cm\b", text))

    def _list_lines(self, first_line: int, last_line: int) -> list[str]:
        lines = self._lines[max(0, first_line - 1) : last_line]
        return [line for line in lines if _MAGIC not in line]


@dataclass(frozen=True, slots=True)
class Spin:
    """Moves that turn the two wheels in opposite directions, where the program says that it drives straight on."""

    first_line: int
    last_line: int
    words: str
    """The two speeds."""


def _list_spins(tree: ast.Module, remarks: Remarks) -> Iterator[Spin]:
    """Yield the moves of both wheels in opposite directions that should drive the robot straight on."""
    forwards = {
        part
        for node in ast.walk(tree)
        if isinstance(node, ast.FunctionDef) and is_forwards(node.name)
        for part in ast.walk(node)
    }
    for block in list_blocks(tree):
        for first, second in pairwise([*block, ast.Pass()]):
            speeds = _list_speeds(first) or _list_speed(first) + _list_speed(second)
            if len(speeds) == 2 and speeds[0] == -speeds[1] != 0:
                last = first if _list_speeds(first) else second
                if first in forwards or remarks.goes_straight(first.lineno):
                    words = f"{speeds[0]:g} and {speeds[1]:g}"
                    yield Spin(first.lineno, last.end_lineno or last.lineno, words)


def _list_speeds(statement: ast.stmt) -> list[float]:
    """Return both speeds in a statement such as `tank.on(30, -30)` if they are opposite; else an empty list."""
    match statement:
        case ast.Expr(
            value=ast.Call(func=ast.Attribute(attr=method), args=args, keywords=keywords)
        ):
            named = {each.arg: each.value for each in keywords}
            speeds = [named[name] for name in ("left_speed", "right_speed") if name in named]
            left, right, *_ = [*args, *speeds, ast.Constant(0), ast.Constant(0)]
            if method in ("on", "on_for_seconds", "on_for_rotations", "on_for_degrees"):
                numbers = [*_list_numbers(left), *_list_numbers(right)]
                return numbers if len(numbers) == 2 and numbers[0] == -numbers[1] else []
    return []


def _list_speed(statement: ast.stmt) -> list[float]:
    """Return the speed in a statement that starts one motor, such as `motor.on(30)`; else an empty list."""
    match statement:
        case ast.Expr(value=ast.Call(func=ast.Attribute(attr="on" | "run"), args=[speed])):
            return _list_numbers(speed)
    return []


def _list_numbers(node: ast.expr) -> list[float]:
    match node:
        case ast.Constant(value=int() | float() as number):
            return [float(number)]
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            return [-number for number in _list_numbers(operand)]
        case ast.Call(func=ast.Name(id=name), args=[speed]) if name.startswith("Speed"):
            return _list_numbers(speed)
    return []


@dataclass(frozen=True, slots=True)
class WrongUnit:
    """A call whose numbers are probably meant in another unit or in another order."""

    line: int
    text: str
    is_endless: bool = False
    """Whether the call is only wrong if the run was cut off in its line."""


_MIN_SLEEP = 100
"""A sleep of so many seconds was meant in milliseconds."""
_MIN_SPEED = 15
_MAX_TIME = 10
"""Equal numbers of at least `_MIN_SPEED` are speeds; a number of at most `_MAX_TIME` before them is a time."""


def _list_wrong_units(tree: ast.Module, remarks: Remarks) -> Iterator[WrongUnit]:
    """Yield the calls whose numbers are probably meant in another unit or in another order."""
    ways = dict(_list_centimetres(tree, remarks))
    for node in ast.walk(tree):
        match node:
            case ast.Call(func=ast.Attribute(attr="straight"), args=[number, *_]) if (
                remarks.has_centimetres(node.lineno, _round(number))
            ):
                way = _round(number)
                text = f"straight({way}) drives {way} mm: straight({way * 10}) drives {way} cm"
                yield WrongUnit(node.lineno, text)
            case ast.Call(func=ast.Attribute(attr="straight"), args=[ast.Name(id=name), *_]) if (
                name in ways
            ):
                text = f"straight counts in mm, but {name} is in cm: line {ways[name]} says so"
                yield WrongUnit(node.lineno, text)
            case ast.Call(
                func=ast.Name(id="sleep") | ast.Attribute(attr="sleep"),
                args=[ast.Constant(value=int() | float() as seconds)],
            ) if seconds >= _MIN_SLEEP:
                text = f"sleep({seconds}) waits {seconds} s, not ms: sleep({seconds / 1000:g}) waits {seconds} ms"
                yield WrongUnit(node.lineno, text, is_endless=True)
            case ast.Call(func=ast.Attribute(attr="on_for_seconds"), args=[*args], keywords=[]):
                if text := _describe_order([_list_numbers(arg) for arg in args]):
                    yield WrongUnit(node.lineno, text, is_endless=True)


def _list_centimetres(tree: ast.Module, remarks: Remarks) -> Iterator[tuple[str, int]]:
    """Yield each name to which a number in cm is assigned, as a comment says, and the line."""
    for node in ast.walk(tree):
        match node:
            case ast.Assign(targets=[ast.Name(id=name)], value=value):
                if remarks.has_centimetres(node.lineno, _round(value)):
                    yield name, node.lineno


def _round(node: ast.expr) -> int:
    numbers = _list_numbers(node)
    return round(abs(numbers[0])) if numbers else 0


def _describe_order(numbers: Sequence[list[float]]) -> str:
    """Return why the numbers of `on_for_seconds` are wrong if the time comes first; else an empty text."""
    match numbers:
        case [[seconds], [left], [right]] if (
            left == right >= _MIN_SPEED and 0 < seconds <= _MAX_TIME
        ):
            speeds = f"{seconds:g} % on the left and {left:g} % on the right for {right:g} s"
        case [[seconds], [speed]] if speed >= _MIN_SPEED and 0 < seconds <= _MAX_TIME:
            speeds = f"{seconds:g} % for {speed:g} s"
        case _:
            return ""
    return f"on_for_seconds takes the time last: this is {speeds}"


def _list_late_stops(tree: ast.Module, remarks: Remarks) -> Iterator[tuple[int, int, int]]:
    """Yield the line of a `while` loop, of a sleep after the loop, and of a stop of motors after the sleep.

    Only loops are included after which a comment names a band before the sleep.
    """
    for node in ast.walk(tree):
        block = getattr(node, "body", None)
        statements = block if isinstance(block, list) else []
        for index, loop in enumerate(statements):
            rest = statements[index + 1 : index + 4]
            names = [name_call(each) for each in rest]
            if isinstance(loop, ast.While) and "sleep" in names[:-1]:
                place = names.index("sleep")
                is_plain = set(names[:place]) <= {"print"} and names[place + 1] in ("off", "stop")
                if is_plain and remarks.names_band(loop.end_lineno or 0, rest[place].lineno):
                    yield loop.lineno, rest[place].lineno, rest[place + 1].lineno
