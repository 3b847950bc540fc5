"""The answers that a task asks for, as lines that a program could print without doing anything for them."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from contextlib import suppress
from re import _constants as op  # type: ignore[attr-defined]
from re import _parser  # type: ignore[attr-defined]
from typing import Any

from tuisim.engine.core.conditions import Operator, ValueCondition, ValueSource
from tuisim.tasks.goals.comparisons import CountCondition, WhenCondition
from tuisim.tasks.goals.condition import Condition, UnjudgedError
from tuisim.tasks.goals.patterns import build_search
from tuisim.tasks.goals.spec import DialogueCondition, Goal, LogCondition, PrintCondition

ASK = ""
"""Stands for a question, which is answered."""
_MAX_REPEATED = 200
_LETTERS = "a1 .:-AZ_"
"""Characters that stand for a class of them, the first that fits."""


def answer_lines(goals: Sequence[Goal]) -> list[str]:
    """Return the lines that meet the goals, in an order that their `after` allows; `ASK` stands for a question."""
    by_name = {goal.name: goal for goal in goals}
    ordered: dict[str, Goal] = {}

    def add(goal: Goal) -> None:
        # This ends: goals do not refer to each other in a circle.
        if goal.name not in ordered:
            if isinstance(goal.after, str):
                add(by_name[goal.after])
            ordered[goal.name] = goal

    for goal in goals:
        add(goal)
    return [line for goal in ordered.values() for part in goal.parts for line in _build_lines(part)]


def _build_lines(condition: Condition) -> Iterator[str]:
    match condition:
        case PrintCondition(lines=lines):
            yield from map(build_matching_line, lines)
        case LogCondition(name=name, levels=levels):
            yield from (f"{name}: {level:.12g}" for level in levels)
        case WhenCondition(conditions=conditions):
            yield from (line for comparison in conditions if (line := _build_line(comparison)))
        case CountCondition(condition=comparison, at_least=times):
            yield from [_build_line(comparison)] * times if _build_line(comparison) else ()
        case DialogueCondition(turns=turns):
            for turn in turns:
                yield ASK
                yield from [build_matching_line(turn.reply)] if turn.reply else ()


def _build_line(condition: ValueCondition) -> str:
    """Return a line that makes a condition true; empty if none does."""
    if condition.source is ValueSource.PRINT:
        return build_matching_line(condition.value)
    if condition.source is not ValueSource.SAMPLE:
        return ""
    name = condition.name or "Value"
    if condition.is_momentary:
        return f"{name}: 1" if condition.operator is Operator.SEEN else f"{name}: 1\n{name}: 2"
    with suppress(ValueError):
        number = condition.number
        candidate = next(
            (value for value in (number, number - 1, number + 1) if condition.test()(value, value)),
            number,
        )
        return f"{name}: {candidate:.12g}"
    return ""


def build_matching_line(pattern: str) -> str:
    """Return a line that a regular expression matches; if none is found easily, the words of the expression."""
    plain = re.sub(r"[\\^$.|?*+(){}\[\]]", "", pattern)
    with suppress(re.error, RecursionError, IndexError, OverflowError, UnjudgedError):
        line = _build_text(_parser.parse(pattern), {})
        return line if "\n" not in line and build_search(pattern)(line) else plain
    return plain


def _build_text(parsed: Any, groups: dict[int, str]) -> str:
    """Return a text that matches a parsed expression; its lookarounds are ignored."""
    return "".join(_build_part(kind, value, groups) for kind, value in parsed)


def _build_part(kind: object, value: Any, groups: dict[int, str]) -> str:
    match kind:
        case op.LITERAL:
            return chr(value)
        case op.ANY:
            return "a"
        case op.NOT_LITERAL:
            return next(letter for letter in _LETTERS if ord(letter) != value)
        case op.IN:
            return _pick_character(value)
        case op.BRANCH:
            return _build_text(value[1][0], groups)
        case op.SUBPATTERN:
            text = _build_text(value[3], groups)
            if value[0] is not None:
                groups[value[0]] = text
            return text
        case op.MAX_REPEAT | op.MIN_REPEAT | op.POSSESSIVE_REPEAT:
            return _build_text(value[2], groups) * int(min(value[0], _MAX_REPEATED))
        case op.ATOMIC_GROUP:
            return _build_text(value, groups)
        case op.GROUPREF:
            return groups.get(value, "")
    return ""


def _pick_character(members: Any) -> str:
    """Return a character that a class such as `[a-z]` matches.

    Args:
        members: The parsed class.
    """
    inside = [(kind, value) for kind, value in members if kind is not op.NEGATE]
    is_negated = len(inside) < len(members)
    candidates = [
        chr(value if kind is op.LITERAL else value[0])
        for kind, value in inside
        if kind in (op.LITERAL, op.RANGE)
    ]
    character: str
    for character in (*candidates, *_LETTERS):
        if any(_is_member(ord(character), kind, value) for kind, value in inside) is not is_negated:
            return character
    return _LETTERS[0]


def _is_member(code: int, kind: object, value: Any) -> bool:
    match kind:
        case op.LITERAL:
            return bool(code == value)
        case op.RANGE:
            return bool(value[0] <= code <= value[1])
        case op.CATEGORY:
            letter = {
                op.CATEGORY_DIGIT: r"\d",
                op.CATEGORY_NOT_DIGIT: r"\D",
                op.CATEGORY_SPACE: r"\s",
                op.CATEGORY_NOT_SPACE: r"\S",
                op.CATEGORY_WORD: r"\w",
                op.CATEGORY_NOT_WORD: r"\W",
            }
            return re.match(letter[value], chr(code)) is not None
    return False
