"""Tries a task out for its author: what programs earn that do nothing for it, its model, and wrong examples."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from contextlib import closing, suppress
from dataclasses import replace
from enum import StrEnum
from itertools import chain
from pathlib import Path
from re import _compiler, _parser  # type: ignore[attr-defined]
from re import _constants as op  # type: ignore[attr-defined]
from typing import Any

from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError
from tuisim.engine.core.conditions import Operator, ValueCondition, ValueSource
from tuisim.engine.runs.handle import RunOptions
from tuisim.engine.runs.temporary import create_temporary_home
from tuisim.programs.program_file import find_program
from tuisim.settings.options import Settings
from tuisim.tasks.goals.comparisons import CountCondition, WhenCondition
from tuisim.tasks.goals.condition import Condition, ConditionKind, UnjudgedError
from tuisim.tasks.goals.files import GoalsFile
from tuisim.tasks.goals.judgement import format_points
from tuisim.tasks.goals.patterns import build_search
from tuisim.tasks.goals.spec import (
    AvoidCondition,
    DialogueCondition,
    FinishCondition,
    Goal,
    LogCondition,
    PrintCondition,
    UseCondition,
)
from tuisim.tasks.marks.entries import build_entries
from tuisim.tasks.marks.journal import Journal
from tuisim.tasks.marks.outcome import Outcome, find_unknown_goals
from tuisim.tasks.marks.runs import STALL_LIMIT_S, MarkPlan, run_entries
from tuisim.tasks.marks.sheet import Sheet, SheetRow, build_sheet, list_columns
from tuisim.tasks.marks.students import Student, find_students
from tuisim.tasks.task import Keep

ASK = ""
"""A line that means a question, which the program must ask."""
_MAX_REPEATED = 200
_LETTERS = "a1 .:-AZ_"
"""Characters that are tried first for a class of them."""
_FIRST_LETTER, _LAST_LETTER = 32, 0xD7FF
"""Codes of the other characters that are tried, from the blank on."""


def answer_lines(goals: Sequence[Goal]) -> list[str]:
    """Return lines of output that meet the goals, in an order that the goals' key `after` allows.

    `ASK` stands where the program has to ask a question with `input()`.
    """
    by_name = {goal.name: goal for goal in goals}
    ordered: dict[str, Goal] = {}

    def add(goal: Goal) -> None:
        # The recursion ends, since goals do not refer to each other in a circle.
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
    """Return a line of output that makes a comparison true; empty if no line does."""
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
    """Return a line that a regular expression matches.

    If none is easy to find, return the expression without its special characters.
    """
    plain = re.sub(r"[\\^$.|?*+(){}\[\]]", "", pattern)
    with suppress(re.error, RecursionError, IndexError, OverflowError, UnjudgedError):
        line = _build_text(_parser.parse(pattern), {})
        return line if "\n" not in line and build_search(pattern)(line) else plain
    return plain


def _build_text(parsed: Any, groups: dict[int, str]) -> str:
    """Return a text that a parsed regular expression matches; lookarounds in it are ignored."""
    return "".join(_build_part(kind, value, groups) for kind, value in parsed)


def _build_part(kind: object, value: Any, groups: dict[int, str]) -> str:
    match kind:
        case op.LITERAL:
            return chr(value)
        case op.ANY | op.NOT_LITERAL | op.IN:
            return _pick_character(kind, value)
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


def _pick_character(kind: object, value: Any) -> str:
    """Return a character that a class of a parsed regular expression, such as `[a-z]`, matches; empty for none."""
    part = _parser.SubPattern(_parser.State(), [(kind, value)])
    letters = chain(_LETTERS, map(chr, range(_FIRST_LETTER, _LAST_LETTER)))
    return next(filter(_compiler.compile(part).match, letters), "")


STILL_S = 30.0
"""Simulated seconds for which the program that only stands still waits."""


class TrialRole(StrEnum):
    """The kind of a program with which a task is tried, such as an empty program or the author's model."""

    EMPTY = "empty program"
    STILL = "stands still"
    PRINTS = "prints the answers"
    MODEL = "model"
    WRONG = "wrong example"


_DOES = {
    TrialRole.EMPTY: "an empty program",
    TrialRole.STILL: "standing still",
    TrialRole.PRINTS: "printing the answers",
}
"""Programs that do nothing for the task, and what they do, in words."""


@dataclass(frozen=True, slots=True)
class TaskTrial:
    """The result of trying a task with several programs."""

    rows: tuple[tuple[str, str, str], ...]
    """The name of each program, its points, and which goals it meets."""
    faults: tuple[str, ...]
    """What is wrong with the task, each as a line."""


def run_trial(
    task: GoalsFile,
    wrong: Sequence[str],
    seeds: tuple[int, ...],
    *,
    time_limit_s: float,
    jobs: int,
) -> TaskTrial:
    """Try a task with the author's model and wrong programs, and with programs that do nothing; block while they run.

    Args:
        task: The task.
        wrong: Files or folders of programs that must not get all points.
        seeds: The seeds with which each program is run.
        time_limit_s: Simulated seconds that a program may take.
        jobs: Number of workers; 0 is one for each processor.

    Raises:
        ConfigError: the world, or a program of the author's, is wrong.
        LogError: a recording cannot be read or written.
    """
    plan = MarkPlan(
        worlds=task.worlds,
        seeds=seeds,
        options=RunOptions(time_limit_s=time_limit_s, stall_limit_s=STALL_LIMIT_S),
        keep=Keep.NONE,
        jobs=jobs,
        arguments=Settings.merge(task.settings)["arguments"],
    )
    with create_temporary_home("tuisim-try-") as home:
        tried = [*_write_fakes(task, home), *_list_author_programs(task, wrong)]
        entries, students = build_entries([student for _, student in tried], task, {})
        outcomes: dict[str, list[Outcome]] = {student.name: [] for student in students}
        with (
            Journal(home / "journal.jsonl", resumes=False) as journal,
            closing(run_entries(entries, plan, journal)) as results,
        ):
            for name, outcome in results:
                outcomes[name].append(outcome)
    worlds = [world.where for world in plan.worlds]
    sheet = build_sheet(
        task.title, list_columns(task.every_goal), plan.seeds, students, outcomes, worlds
    )
    rows = tuple((row.name, *_describe_earned(sheet, row)) for row in sheet.rows)
    return TaskTrial(rows, tuple(_find_faults(sheet, [role for role, _ in tried])))


def _describe_earned(sheet: Sheet, row: SheetRow) -> tuple[str, str]:
    """Return a program's points, such as `3 of 5`, and the names of the goals that it meets, or `all`."""
    met = [column.name for column, cell in zip(sheet.columns, row.cells, strict=True) if cell.met]
    good = all(
        (cell.met == row.runs) is (column.points >= 0)
        for column, cell in zip(sheet.columns, row.cells, strict=True)
    )
    names = "all" if good and row.runs else ", ".join(met) or "-"
    return f"{format_points(row.points)} of {format_points(sheet.most_points)}", names


def _write_fakes(task: GoalsFile, folder: Path) -> Iterator[tuple[TrialRole, Student]]:
    """Write programs that do not do the task into a folder, and yield each as a student, with its kind.

    They are an empty program, one that waits, and one that prints the lines that the goals require.
    """
    still = f"import time\n\ntime.sleep({STILL_S:g})\n"
    texts = {TrialRole.EMPTY: "", TrialRole.STILL: still}
    if lines := answer_lines(task.goals):
        prints = [
            f"print({line!r})\ntime.sleep(0.1)" if line is not ASK else "input()" for line in lines
        ]
        texts[TrialRole.PRINTS] = "\n".join(["import time", "", *prints, ""])
    for role, text in texts.items():
        path = folder / f"{role}.py"
        path.write_text(text, encoding="utf-8")
        yield role, find_students([str(path)]).students[0]


def _list_author_programs(
    task: GoalsFile, wrong: Sequence[str]
) -> Iterator[tuple[TrialRole, Student]]:
    """Yield the model and the wrong examples of a task's author as students, each with its kind.

    Raises:
        ConfigError: a program is missing, or is not valid Python.
    """
    model = [(TrialRole.MODEL, str(find_program(task.program)))] if task.program else []
    for role, path in [*model, *((TrialRole.WRONG, path) for path in wrong)]:
        for student in find_students([path]).students:
            if student.source is None:
                raise ConfigError(student.problem, f"a {role} of the task", file=str(student.path))
            yield role, replace(student, name=f"{student.path.name} ({role})")


def _find_faults(sheet: Sheet, roles: Sequence[TrialRole]) -> Iterator[str]:
    """Yield the faults of a task that its trial shows, one line each.

    Args:
        sheet: The marks of the programs.
        roles: The kind of each program, in the order of the rows.
    """
    rows = list(zip(sheet.rows, roles, strict=True))
    for index, goal in enumerate(sheet.columns):
        if by := [
            _DOES[role]
            for row, role in rows
            if role in _DOES and row.cells[index].met and goal.points >= 0
        ]:
            points = (
                f" ({format_points(goal.points)} of {format_points(sheet.most_points)} points)"
                if goal.points
                else ""
            )
            yield f"{' and '.join(by)} meets “{goal.name}”{points}: {_suggest_remedy(goal)}"
    for name, reason in find_unknown_goals(
        outcome for row in sheet.rows for outcome in row.outcomes
    ).items():
        yield f"“{name}” cannot be judged: {reason}"
    for row, role in rows:
        if role is TrialRole.MODEL and row.robustness < 1:
            where = f"line {row.line}: " if row.line else ""
            yield f"the model {row.program} does not get all points: {where}{row.reason}"
        elif role is TrialRole.WRONG and row.robustness == 1:
            yield f"the wrong example {row.program} gets all points"


def _suggest_remedy(goal: Goal) -> str:
    """Return how to change a goal that a program meets without doing the task."""
    for part in goal.parts:
        match part:
            case FinishCondition():
                return "every program ends: give it `after`, a goal that the robot must have met"
            case PrintCondition() | LogCondition() | DialogueCondition():
                return (
                    "give it `after`, `x_mm` or `reading`, for what the robot must have done before"
                )
            case AvoidCondition() | UseCondition():
                return "give it a second condition, one that the robot must meet"
    if goal.until is not None:
        return "a program that does nothing meets this goal: join it by `all` with a goal that the robot must meet"
    if any(part.KIND is ConditionKind.HELD for part in goal.parts):
        return "a robot that stands still meets this goal: give it `until`, a goal that the robot must meet"
    return "give it `after`, a goal that the robot must have met"
