"""The intentions of a program that its comments, prints and names tell, and the lines that should carry them out."""

from __future__ import annotations

import ast
import re
from collections.abc import Collection, Iterator, Sequence
from itertools import pairwise

from tuisim.base.data_class import dataclass
from tuisim.base.source import source_lines
from tuisim.programs.moves import ANY_MOVE, STARTS
from tuisim.programs.robot.words import is_forwards
from tuisim.programs.statements import find_call, find_number, list_blocks
from tuisim.programs.wrong_calls import find_classes

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
_STRAIGHT = re.compile(r"\bstraight\b", re.IGNORECASE)
_TURNS = re.compile(r"turn|spin|rotat|dance|circle|dreh|kreis|around", re.IGNORECASE)
_CURVES = re.compile(r"curve|arc|bend|kurve|bogen|left|right|links|rechts|follow", re.IGNORECASE)
_SIDES = {
    "left": re.compile(r"left|links", re.IGNORECASE),
    "right": re.compile(r"(?<!b)right|rechts", re.IGNORECASE),
}
_NO_SIDES = re.compile(
    r"motor|wheel|sensor|eye|light|arm|servo|head|angle|way|hand|edge|line|side|button|\b(not|if|or|rad)\b",
    re.IGNORECASE,
)
"""Words with which a remark is not, or not only, about the side to which the robot turns."""
_BEFORE_LINES = 4
_AFTER_LINES = 3
"""A remark is about a loop if it is so near to it."""
_SPEEDS = ("speed", "left_speed", "right_speed")
"""The names of arguments that are speeds."""


class Remarks:
    """The lines of a program whose comments, prints and names say what the program is meant to do.

    Args:
        text: The program.
        tree: Its syntax tree.
    """

    def __init__(self, text: str, tree: ast.Module) -> None:
        self._lines = source_lines(text)
        self._tree = tree

    def find_color(self, first_line: int, last_line: int, ends: Collection[int] = ()) -> str:
        """Return `black` or `white` if the lines in and around a loop name this colour and no other.

        The result is empty in any other case.

        Args:
            first_line: The first line of the loop.
            last_line: The last line of the loop.
            ends: The first and last lines of all loops, at which the search for colours ends.
        """
        start = max([line + 1 for line in ends if line < first_line], default=0)
        end = min([line for line in ends if line > last_line], default=len(self._lines) + 1)
        first_line = max(start, first_line - _BEFORE_LINES)
        text = self._read_lines(first_line, min(end - 1, last_line + _AFTER_LINES))
        colors = [name for name, words in _COLORS.items() if words.search(text)]
        return colors[0] if len(colors) == 1 and not _OTHERS.search(text) else ""

    def goes_straight(self, line: int) -> bool:
        """Return whether a line, or a comment above it, says that the robot drives straight on."""
        above = self._read_lines(line - 1, line - 1)
        is_comment = above.lstrip().startswith("#")
        text = self._read_lines(line - is_comment, line)
        return (is_forwards(text) or bool(_STRAIGHT.search(text))) and not _TURNS.search(text)

    def find_side(self, line: int) -> str:
        """Return the side to which a comment on a line, or one above it, says that the robot turns; empty for none."""
        return _find_side(self._read_comment(line))

    def has_straight_comment(self, line: int) -> bool:
        """Return whether a comment on or above a line says that the robot drives straight on, and nothing of turns."""
        text = self._read_comment(line).replace("rotations", "")
        is_straight = is_forwards(text) or bool(_STRAIGHT.search(text))
        return is_straight and not (_TURNS.search(text) or _CURVES.search(text))

    def list_spins(self) -> Iterator[NamedAim]:
        """Yield moves that turn the wheels in opposite directions, although the program says "straight"."""
        forwards = {
            part
            for node in ast.walk(self._tree)
            if isinstance(node, ast.FunctionDef) and is_forwards(node.name)
            for part in ast.walk(node)
        }
        for block in list_blocks(self._tree):
            for first, second in pairwise([*block, ast.Pass()]):
                speeds, last = _list_speeds(first), first
                if len(speeds) == 1:
                    speeds, last = speeds + _list_speeds(second), second
                is_spin = len(speeds) == 2 and speeds[0] == -speeds[1] != 0
                if is_spin and (first in forwards or self.goes_straight(first.lineno)):
                    words = f"{speeds[0]:g} and {speeds[1]:g}"
                    yield NamedAim(first.lineno, last.end_lineno or last.lineno, "straight", words)

    def list_curves(self) -> Iterator[NamedAim]:
        """Yield moves that drive in a curve, although a comment says that they drive straight.

        Their two numbers are in the wrong form for the class: a steering and a speed, or a speed for each wheel.
        """
        classes = find_classes(self._tree)
        for node in ast.walk(self._tree):
            match node:
                case ast.Expr(value=ast.Call(func=ast.Attribute(value=owner), args=[_, _, *_])) if (
                    speeds := _list_speeds(node)
                ):
                    words = _describe_curve(classes.get(ast.unparse(owner), ""), *speeds)
                    if words and self.has_straight_comment(node.lineno):
                        yield NamedAim(
                            node.lineno, node.end_lineno or node.lineno, "straight", words
                        )

    def list_named_turns(self) -> Iterator[NamedAim]:
        """Yield the functions and moves of a program whose name or comment says to which side the robot turns.

        Functions that are also called with negative numbers are left out.
        """
        nodes = [*ast.walk(self._tree)]
        backwards = {
            ast.unparse(node.func)
            for node in nodes
            if isinstance(node, ast.Call) and any((find_number(arg) or 0) < 0 for arg in node.args)
        }
        for node in nodes:
            match node:
                case ast.FunctionDef(name=name) if name not in backwards and (
                    side := _find_side(name)
                ):
                    yield NamedAim(node.lineno, node.end_lineno or node.lineno, side, name)
                case ast.Expr() if find_call(node, ANY_MOVE) and (
                    side := self.find_side(node.lineno)
                ):
                    # The line after one that starts motors is the one that waits.
                    last_line = (node.end_lineno or node.lineno) + bool(find_call(node, STARTS))
                    yield NamedAim(node.lineno, last_line, side, "the comment")

    def list_wrong_units(self) -> Iterator[WrongUnit]:
        """Yield the calls whose numbers are probably meant in another unit or in another order."""
        ways = {
            name: node.lineno
            for node in ast.walk(self._tree)
            if isinstance(node, ast.Assign)
            and self.has_centimetres(node.lineno, find_number(node.value))
            for name in map(ast.unparse, node.targets)
        }
        for node in ast.walk(self._tree):
            match node:
                case ast.Call(
                    func=ast.Attribute(attr="straight"), args=[ast.Name(id=name), *_]
                ) if name in ways:
                    text = f"straight counts in mm, but {name} is in cm: line {ways[name]} says so"
                    yield WrongUnit(node.lineno, text)
                case ast.Call(func=ast.Attribute(attr="straight"), args=[number, *_]) if (
                    self.has_centimetres(node.lineno, way := find_number(number))
                ):
                    text = f"straight({way:g}) drives {way:g} mm: straight({(way or 0) * 10:g}) drives {way:g} cm"
                    yield WrongUnit(node.lineno, text)
                case ast.Call(
                    func=ast.Name(id="sleep") | ast.Attribute(attr="sleep"),
                    args=[ast.Constant(value=int() | float() as seconds)],
                ) if seconds >= _MIN_SLEEP:
                    text = f"sleep({seconds}) waits {seconds} s, not ms: sleep({seconds / 1000:g}) waits {seconds} ms"
                    yield WrongUnit(node.lineno, text, is_endless=True)
                case ast.Call(func=ast.Attribute(attr="on_for_seconds"), args=[*args], keywords=[]):
                    numbers = [find_number(arg) for arg in args]
                    if text := _describe_order(numbers) or _describe_duration(numbers):
                        yield WrongUnit(node.lineno, text, is_endless=True)

    def _read_comment(self, line: int) -> str:
        """Return the comment on a line or, if there is none, the one above it; empty for none."""
        above = self._read_lines(line - 1, line - 1).strip()
        _, _, comment = self._read_lines(line, line).partition("#")
        return comment or (above if above.startswith("#") else "")

    def has_centimetres(self, line: int, number: float | None) -> bool:
        """Return whether a line, or the line above it, contains a number with the unit cm, such as `20 cm`."""
        text = self._read_lines(line - 1, line)
        return bool(number) and bool(re.search(rf"\b{number:g}\b\W{{0,6}}cm\b", text))

    def _read_lines(self, first_line: int, last_line: int) -> str:
        lines = self._lines[max(0, first_line - 1) : last_line]
        return " ".join(line for line in lines if _MAGIC not in line)


@dataclass(frozen=True, slots=True)
class NamedAim:
    """Lines of a program that move the robot, with the direction that a name or a comment gives for this."""

    first_line: int
    last_line: int
    aim: str
    """`straight`, `left` or `right`."""
    words: str
    """The two speeds, which turn the wheels in opposite directions; of a turn, what says the side; of a curve, why."""


def _describe_curve(class_name: str, first: float, second: float = 0.0) -> str:
    """Return why a move with two numbers does not drive straight on; empty if it does, or if that is not known.

    Args:
        class_name: The class of the pair of motors, such as `MoveSteering`.
        first: The first number of the move.
        second: The second number.
    """
    if class_name == "MoveSteering" and first and second:
        return "a MoveSteering takes the steering first, and 0 drives straight on"
    if class_name == "MoveTank" and first != second and 0 in (first, second):
        return "a MoveTank takes a speed for each wheel, and equal ones drive straight on"
    return ""


def _find_side(text: str) -> str:
    """Return the side to which the robot turns according to a name or a comment: `left`, `right`, or empty for none."""
    sides = [side for side, words in _SIDES.items() if words.search(text)]
    is_turn = len(sides) == 1 and _TURNS.search(text) and not _NO_SIDES.search(text)
    return sides[0] if is_turn else ""


def _list_speeds(statement: ast.stmt) -> list[float]:
    """Return the first two numbers in a statement that moves motors, such as `tank.on(30, -30)`; empty for others."""
    match statement:
        case ast.Expr(
            value=ast.Call(func=ast.Attribute(attr=method), args=args, keywords=keywords)
        ) if method in ("run", "on", "on_for_seconds", "on_for_rotations", "on_for_degrees"):
            speeds = [*args, *(each.value for each in keywords if each.arg in _SPEEDS)]
            numbers = [find_number(speed) for speed in speeds[:2]]
            return [number for number in numbers if number is not None]
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
_MIN_MS = 500
"""A move of so many seconds was meant in milliseconds."""
_MIN_SPEED = 15
_MAX_TIME = 10
"""Equal numbers of at least `_MIN_SPEED` are speeds; a number of at most `_MAX_TIME` before them is a time."""


def _describe_order(numbers: Sequence[float | None]) -> str:
    """Return why the numbers of `on_for_seconds` are wrong if the time comes first; else an empty text."""
    match numbers:
        case [float(seconds), float(left), float(right)] if left == right:
            speeds = f"{seconds:g} % on the left and {left:g} % on the right for {right:g} s"
        case [float(seconds), float(left)]:
            speeds = f"{seconds:g} % for {left:g} s"
        case _:
            return ""
    is_time_first = left >= _MIN_SPEED and 0 < seconds <= _MAX_TIME
    return f"on_for_seconds takes the time last: this is {speeds}" if is_time_first else ""


def _describe_duration(numbers: Sequence[float | None]) -> str:
    """Return why the time of `on_for_seconds` is wrong if it was meant in ms; else an empty text."""
    seconds = numbers[-1] if numbers else None
    if seconds is None or seconds < _MIN_MS or seconds % 100:
        return ""
    minutes = f"so this takes {seconds / 60:.0f} minutes"
    return f"on_for_seconds counts seconds, {minutes}: {seconds / 1000:g} s are {seconds:g} ms"
