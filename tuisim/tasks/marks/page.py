"""The sheet of a class as one HTML page: what the class as a whole has met and missed, and each student."""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType

from tuisim.analysis.pins import Picture
from tuisim.base.data_class import dataclass
from tuisim.pictures.html.render import Table, render_page
from tuisim.tasks.goals.judgement import format_points
from tuisim.tasks.goals.spec import Goal
from tuisim.tasks.marks.copies import MIN_TOKENS, Similar
from tuisim.tasks.marks.sheet import Cell, Sheet, SheetRow

_MIN_STUDENTS = 3
"""A class with fewer students gets no statistics of points."""
MAX_REASONS = 3
_NUMBER = re.compile(r"“[^”]*”|(?<![\w.])-?\d[\d,]*(?:\.\d+)?(?![\w.]*\w)")
"""A number in a reason, or a name in quotes, whose numbers are no measurements."""
BINS = 10


Links = Mapping[tuple[str, str, int], str]
"""Relative paths of reports by student, world and seed."""


@dataclass(frozen=True, slots=True)
class GoalStatistics:
    """Statistics of one goal for a class: how many students met it, and their mean points."""

    goal: Goal
    met: int
    """Number of students who met the goal in each of their runs."""
    partly: int
    """Number of students who met the goal in some of their runs, but not in all."""
    mean: float
    """Mean of the points that the students got for the goal."""
    reasons: tuple[tuple[str, int], ...]
    """The most frequent reasons of those who missed it, each with the number of students, see `group_reasons`."""


@dataclass(frozen=True, slots=True)
class _Mark:
    """A cell of the table on a class's page: a student's points for one goal."""

    points: float
    level: str
    """A class of the style."""
    hint: str


@dataclass(frozen=True, slots=True)
class _Student:
    """A row of the table on a class's page: one student."""

    row: SheetRow
    level: str
    marks: tuple[_Mark, ...]
    reports: tuple[tuple[str, list[tuple[str, str]]], ...]
    """For each world the paths of its reports, each with the seeds in words."""


def build_page(
    sheet: Sheet,
    links: Links = MappingProxyType({}),
    ignored: Sequence[str] = (),
    similar: Similar | None = None,
    maps: Sequence[Picture] = (),
) -> str:
    """Return the page on the marks of a class, as HTML.

    Args:
        sheet: The marks of the class.
        links: The paths of the reports of kept runs.
        ignored: Names of files that are no programs.
        similar: Which programs resemble each other; None if they were not compared.
        maps: Pictures of where goals were missed.
    """
    goals = [column.name for column in sheet.columns]
    return render_page(
        "marks.html",
        title=f"Marks: {sheet.title}" if sheet.title else "Marks",
        summary=sheet.summary,
        bins=compute_distribution(sheet) if len(sheet.rows) >= _MIN_STUDENTS else (),
        goals=compute_goal_statistics(sheet),
        maps=maps,
        heads=["student", "points", "robustness", *goals, "reason"],
        students=[_build_student(row, sheet, links) for row in sheet.rows],
        ignored=ignored,
        similar=_tabulate(similar) if similar is not None and similar.compared > 1 else None,
        in_words=format_points,
    )


def _build_student(row: SheetRow, sheet: Sheet, links: Links) -> _Student:
    level = (
        _classify_points(row.points, sheet.most_points)
        if sheet.most_points
        else _classify_points(row.robustness, 1.0)
    )
    marks = [
        _mark(cell, column, row.runs) for cell, column in zip(row.cells, sheet.columns, strict=True)
    ]
    return _Student(row, level, tuple(marks), tuple(_find_reports(row, links).items()))


def _classify_points(points: float, max_points: float) -> str:
    if points >= max_points:
        return "met"
    if points:
        return "part"
    return "missed"


def _mark(cell: Cell, column: Goal, runs: int) -> _Mark:
    # The level depends on the runs that met the goal, not on its points, as goals can have no points.
    if runs and cell.met == runs:
        level = "met"
    elif cell.met:
        level = "part"
    else:
        level = "missed"
    if column.points < 0:
        level = "missed" if cell.met else "met"
    seeds = f"met in {cell.met} of {runs} runs" if runs > 1 else ""
    return _Mark(cell.points, level, "; ".join(filter(None, (seeds, cell.reason))))


def _find_reports(row: SheetRow, links: Links) -> dict[str, list[tuple[str, str]]]:
    """Return the reports of a student's runs, by world: the path of each report, and the seeds of its runs as text."""
    seeds: dict[str, dict[str, list[int]]] = {}
    for outcome in row.outcomes:
        if path := links.get((row.name, outcome.world, outcome.seed)):
            seeds.setdefault(outcome.world, {}).setdefault(path, []).append(outcome.seed)
    return {
        world: [(path, _format_ranges(numbers)) for path, numbers in paths.items()]
        for world, paths in seeds.items()
    }


def _format_ranges(seeds: Sequence[int]) -> str:
    """Return ascending numbers as text, with consecutive numbers as ranges, such as `0, 3–5`."""
    ranges: list[list[int]] = []
    for seed in seeds:
        if ranges and seed == ranges[-1][-1] + 1:
            ranges[-1].append(seed)
        else:
            ranges.append([seed])
    return ", ".join(
        f"{numbers[0]}–{numbers[-1]}" if len(numbers) > 1 else str(numbers[0]) for numbers in ranges
    )


def _tabulate(similar: Similar) -> Mapping[str, object]:
    """Return tables of similar programs, and figures about them, by the names that the page's template uses."""
    heads = ("", "equal except for names, numbers and texts", "of these exactly equal")
    groups = [
        (
            str(len(group.names)),
            ", ".join(group.names),
            "; ".join(" = ".join(names) for names in group.same),
        )
        for group in similar.groups
    ]
    pairs = [(*pair.names, f"{pair.share:.0%}", str(pair.lines)) for pair in similar.pairs]
    return {
        "groups": Table(heads, groups, numbers=len(heads)),
        "pairs": Table(("program", "and", "passages in common", "lines"), pairs, numbers=2),
        "compared": similar.compared,
        "least_tokens": MIN_TOKENS,
    }


def compute_goal_statistics(sheet: Sheet) -> tuple[GoalStatistics, ...]:
    """Return the statistics of each goal that the sheet shows."""
    statistics = []
    for index, goal in enumerate(sheet.columns):
        cells = [(row, row.cells[index]) for row in sheet.rows]
        met = sum(bool(row.runs) and cell.met == row.runs for row, cell in cells)
        partly = sum(0 < cell.met < row.runs for row, cell in cells)
        points = [cell.points for _, cell in cells if not math.isnan(cell.points)]
        mean = math.fsum(points) / len(points) if points else 0.0
        reasons = group_reasons(cell.reason for _, cell in cells if cell.reason)
        statistics.append(GoalStatistics(goal, met, partly, mean, reasons))
    return tuple(statistics)


def group_reasons(reasons: Iterable[str]) -> tuple[tuple[str, int], ...]:
    """Return the most frequent kinds of reasons, each with its number, and then the number of all others.

    Reasons of one kind differ only in numbers, which become ranges, such as `stopped 5 to 40 mm away`.
    """
    groups: dict[str, list[str]] = {}
    for reason in reasons:
        kind = _NUMBER.sub(lambda match: match[0] if match[0][0] == "“" else "#", reason)
        groups.setdefault(kind, []).append(reason)
    kinds = sorted(groups.values(), key=len, reverse=True)
    counts = [(_join_reasons(each), len(each)) for each in kinds[:MAX_REASONS]]
    others = sum(map(len, kinds[MAX_REASONS:]))
    return (*counts, *([("other reasons", others)] if others else []))


def _join_reasons(reasons: Sequence[str]) -> str:
    """Return one reason for several that differ only in numbers, with ranges such as `5 to 40` for these numbers."""
    columns = zip(*map(_NUMBER.findall, reasons), strict=True)
    ranges = iter([sorted(set(column), key=_read_number) for column in columns])

    def join(_: re.Match[str]) -> str:
        numbers = next(ranges)
        return numbers[0] if len(numbers) == 1 else f"{numbers[0]} to {numbers[-1]}"

    return _NUMBER.sub(join, reasons[0])


def _read_number(text: str) -> float:
    return float(text.replace(",", "")) if text[0] != "“" else 0.0


def compute_distribution(sheet: Sheet) -> tuple[tuple[float, float, int], ...]:
    """Divide the scale of points into equal parts; return for each its lower end, upper end and number of students.

    A student at the border of two parts counts in the upper part, a student beyond the scale in the first or last part.
    The result is empty if no points can be earned, or no student's points are known.
    """
    max_points = sheet.most_points
    known = [row.points for row in sheet.rows if not math.isnan(row.points)]
    if not max_points or not known:
        return ()
    counts = Counter(min(max(int(points / max_points * BINS), 0), BINS - 1) for points in known)
    return tuple(
        (max_points * part / BINS, max_points * (part + 1) / BINS, counts[part])
        for part in range(BINS)
    )


def build_reports_folder(file: Path) -> Path:
    """Return the path of the folder with the reports to which a page links."""
    return file.with_name(f"{file.stem}-runs")
