"""Feedback: a text file for each student, with what was met, what was missed, why, and a hint."""

from __future__ import annotations

import math
import os
from collections.abc import Iterable, Sequence
from pathlib import Path
from textwrap import fill

from tuisim.base.atomic import replacing
from tuisim.base.errors import ExportError, printable
from tuisim.base.faults import describe_fault
from tuisim.base.source import source_lines
from tuisim.tasks.goals.judge import UNCOMPILED
from tuisim.tasks.goals.judgement import format_points
from tuisim.tasks.goals.spec import Goal
from tuisim.tasks.marks.sheet import Cell, Sheet, SheetRow

SUFFIX = ".txt"
WIDTH = 88
MAX_ERROR_LINES = 20
_ELSEWHERE = "in every other world in which it ran"
"""The only text on a hidden world."""
MAX_NAME_BYTES = 160
"""Longer names of files are cut off: with seed and suffix they must fit into the 255 bytes of common file systems."""
_FORBIDDEN = frozenset('/\\:*?"<>|')
"""Characters that some file systems, or links of a page, do not take in a name."""


def build_file_stems(names: Iterable[str]) -> list[str]:
    """Return a name for each student's file, without its suffix: all distinct, and without unusual characters.

    Two students' names may become equal when unusual characters are replaced; all but one of them then get a number. A
    name without unusual characters is kept as it is.
    """
    names = [*names]
    plain = [_make_plain(name) for name in names]
    stems: dict[int, str] = {}
    taken: set[str] = set()
    for index in sorted(range(len(names)), key=lambda index: plain[index] != names[index]):
        number = 1
        candidate = plain[index]
        while candidate.casefold() in taken:
            number += 1
            candidate = f"{plain[index]}-{number}"
        taken.add(candidate.casefold())
        stems[index] = candidate
    return [stems[index] for index in range(len(names))]


def _make_plain(name: str) -> str:
    plain = "".join(
        "_" if character in _FORBIDDEN or not character.isprintable() else character
        for character in name
    )
    return plain.encode()[:MAX_NAME_BYTES].decode(errors="ignore").strip(" .") or "student"


def build_feedback(sheet: Sheet, row: SheetRow, source: str = "") -> str:
    """Return the feedback for one student as plain text.

    Args:
        sheet: The marks of the class.
        row: The marks of the student.
        source: The text of the student's main program, whose lines are quoted.
    """
    try:
        return _build_feedback(sheet, row, source)
    except Exception as error:  # Any error concerns this student only; the others get feedback.
        return f"{describe_fault(error)}\n"


def _build_feedback(sheet: Sheet, row: SheetRow, source: str) -> str:
    head = f"{row.name}: {format_points(row.points)} of {format_points(sheet.most_points)} points"
    parts = (
        [head, "=" * min(len(head), WIDTH), "", sheet.title, ""] if sheet.title else [head, "", ""]
    )
    if row.comment:
        parts += [_wrap(f"Comment: {row.comment}"), ""]
    parts += _describe_frequency(row)
    if row.failure and row.hidden:
        parts += [_wrap(f"Your program did not run to its end {_ELSEWHERE}."), ""]
    elif row.failure:
        parts += [_wrap(f"Your program did not run to its end: {row.failure}"), ""]
        parts += [f"    {line}" for line in source_lines(row.error)[-MAX_ERROR_LINES:]]
        parts += [""] if row.error else []
    if row.diagnosis:
        parts += [_wrap(f"What went wrong, with seed {row.seed}: {row.diagnosis}."), ""]
    if row.refusal:
        parts += [_wrap(f"Your program would not run on a brick: {row.refusal}"), ""]
    quoted = source_lines(source)
    cells = list(zip(sheet.columns, row.cells, strict=True))
    for column, cell in cells:
        # Why a program does not compile is said above, once for all goals.
        is_explained = bool(row.failure) and cell.reason.startswith(UNCOMPILED)
        if not column.hidden:
            parts += _describe_goal(column, cell, row.runs, quoted, is_explained=is_explained)
            parts.append("")
    parts += _describe_hidden([(column, cell) for column, cell in cells if column.hidden])
    lines = "\n".join(parts).rstrip("\n").split("\n")
    return "".join(f"{printable(line)}\n" for line in lines)


def _describe_frequency(row: SheetRow) -> list[str]:
    if any(cell.reason.startswith(UNCOMPILED) for cell in row.cells):
        # It never began.
        return []
    if row.stopped_early:
        return ["Your program ran once: it would not end in other runs either.", ""]
    if row.runs < 2:
        return []
    full = round(row.robustness * row.runs)
    return [
        _wrap(
            f"Your program ran {row.runs} times, each time with different random numbers: "
            f"{full} of {row.runs} runs met every goal."
        ),
        "",
    ]


def _describe_hidden(cells: Sequence[tuple[Goal, Cell]]) -> list[str]:
    """Return lines for the feedback with the points of all hidden goals together; empty if there are none.

    Args:
        cells: The hidden goals, each with the student's result.
    """
    max_points = math.fsum(max(column.points, 0.0) for column, _ in cells)
    points = math.fsum(cell.points for _, cell in cells)
    return (
        [f"Hidden goals: {format_points(points)} of {format_points(max_points)} points", ""]
        if cells
        else []
    )


def _describe_goal(
    column: Goal, cell: Cell, runs: int, lines: Sequence[str], *, is_explained: bool
) -> list[str]:
    """Return the paragraphs of the feedback on one goal.

    Args:
        column: The goal.
        cell: The student's result.
        runs: Number of the student's runs.
        lines: The lines of the program, which are quoted.
        is_explained: Whether an earlier paragraph has the reason already, so that it is left out.
    """
    if math.isnan(cell.points):
        return [_wrap(f"[could not be judged] {column.say}")]
    if column.points < 0 and not cell.met:
        return [_wrap(f"[did not happen] {column.say}")]
    is_met = bool(runs) and cell.met == runs
    if column.points < 0:
        mark = "happened"
    elif is_met:
        mark = "met"
    elif not cell.met:
        mark = "missed"
    else:
        mark = "met in part"
    of = f" of {format_points(column.points)}" if column.points > 0 else ""
    points = f" ({format_points(cell.points)}{of})" if column.points else ""
    paragraphs = [_wrap(f"[{mark}] {column.say}{points}")]
    if is_met and column.points >= 0:
        return paragraphs
    if cell.hidden:
        paragraphs.append(
            _wrap(f"Why: it is right in the task's own world, but not {_ELSEWHERE}.", "    ")
        )
    elif cell.met:
        paragraphs.append(
            _wrap(f"Met in {cell.met} of {runs} runs; missed with seed {cell.seed}.", "    ")
        )
    has_why = not (cell.hidden or is_explained)
    if cell.reason and has_why:
        paragraphs.append(_wrap(f"Why: {cell.reason}", "    "))
    if 0 < cell.line <= len(lines) and has_why:
        paragraphs.append(f"    Line {cell.line}: {lines[cell.line - 1].strip()[:WIDTH]}")
    if column.hint:
        paragraphs.append(_wrap(f"Hint: {column.hint}", "    "))
    return paragraphs


def _wrap(text: str, indent: str = "") -> str:
    return fill(
        text, WIDTH, initial_indent=indent, subsequent_indent=indent, break_on_hyphens=False
    )


def write_feedback(folder: Path, sheet: Sheet, sources: Sequence[str]) -> None:
    """Write a file of feedback for each student into a folder, which is created if necessary.

    Existing files are replaced.

    Args:
        folder: The folder.
        sheet: The marks of the class.
        sources: The text of each student's main program, in the order of the rows.

    Raises:
        ExportError: a file cannot be written.
    """
    stems = build_file_stems(row.name for row in sheet.rows)
    try:
        os.makedirs(folder, exist_ok=True)
        for stem, row, source in zip(stems, sheet.rows, sources, strict=True):
            with replacing(folder / f"{stem}{SUFFIX}", durable=False) as handle:
                handle.write(build_feedback(sheet, row, source).encode("utf-8", "backslashreplace"))
    except OSError as error:
        raise ExportError(f"cannot write to {folder}: {error.strerror or error}") from error
