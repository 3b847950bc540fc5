"""The sheet of a class as one HTML page: every text of a student is escaped; its script only sorts and filters."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from urllib.parse import quote

from tuisim import palette
from tuisim.analysis.report import page, paragraph, section
from tuisim.charts.files import clean
from tuisim.goals.spec import Goal
from tuisim.marks.class_page import STYLE, goals_section, points_section, similar_section
from tuisim.marks.copies import Similar
from tuisim.marks.sheet import Cell, Sheet, SheetRow, in_words, summary_of

_SCRIPT = Path(__file__).with_name("page.js")
_VERDICTS = f"""\
.met {{ background: {palette.MET}2e; }}
.part {{ background: {palette.PARTLY}33; }}
.missed {{ background: {palette.MISSED}2b; }}
"""
"""The colours of cells."""

_STYLE = """\
body { max-width: 90rem; }
td.number, th.number, td:last-child, th:last-child { padding-left: .7rem; }
.student { min-width: 7.5rem; max-width: 14rem; overflow-wrap: anywhere; }
.head { white-space: normal; overflow-wrap: break-word; min-width: 5.4rem; max-width: 9rem; }
.students td:last-child { min-width: 16rem; }
.sheet { max-height: 92vh; overflow: auto; }
@media print { .sheet { max-height: none; } .filter { display: none; } }
.students thead th { position: sticky; top: 0; background: var(--paper); }
th button { all: unset; cursor: pointer; }
th button:focus-visible { outline: 2px solid; }
th[aria-sort="ascending"] button::after { content: " ▲"; }
th[aria-sort="descending"] button::after { content: " ▼"; }
.filter { display: flex; flex-wrap: wrap; gap: .6rem; align-items: center; margin: .5rem 0; }
.filter input { width: min(22rem, 100%); }
.filter input, .filter select { font: inherit; padding: .2rem .4rem; }
.goals tbody tr { cursor: pointer; }
ul { margin: 0; padding-left: 1.1rem; }
.comment { border-left: 3px solid var(--rule); padding-left: .5rem; }
tbody tr:hover { background: var(--area); }
details pre { margin: .3rem 0; }
code { font: .85rem ui-monospace, monospace; }
"""

Links = Mapping[tuple[str, str, int], str]
"""Relative paths of reports by student, world and seed."""


def page_of(
    sheet: Sheet,
    links: Links = MappingProxyType({}),
    ignored: Sequence[str] = (),
    similar: Similar | None = None,
    maps: Sequence[str] = (),
) -> str:
    """Return the page.

    Args:
        links: The reports of runs that were kept.
        ignored: Names of files that are no programs.
        similar: Which programs resemble each other.
        maps: Pictures of where goals were missed, as HTML.
    """
    title = f"Marks: {sheet.title}" if sheet.title else "Marks"
    notes = paragraph(
        f"Not marked, because they are no Python programs: {', '.join(ignored)}", soft=True
    )
    body = [
        f"<style>\n{_VERDICTS}{_STYLE}{STYLE}</style>\n<header>\n<h1>{clean(title)}</h1>\n{paragraph(summary_of(sheet))}\n</header>",
        points_section(sheet),
        goals_section(sheet),
        section("Places", *maps),
        section("Students", _students(sheet, links), notes if ignored else ""),
        similar_section(similar),
        f"<script>\n{_SCRIPT.read_text(encoding='utf-8')}</script>",
    ]
    return page(title, body)


def _students(sheet: Sheet, links: Links) -> str:
    heads = (
        "student",
        "points",
        "robustness",
        *(column.name for column in sheet.columns),
        "reason",
    )
    numbers = range(1, len(heads) - 1)
    head = "".join(
        f'<th class="{"number head" if at in numbers else ""}">{clean(text)}</th>'
        for at, text in enumerate(heads)
    )
    rows = [_row(row, sheet, links) for row in sheet.rows]
    return "\n".join(
        (
            f'<div class="wide sheet"><table class="students">\n<thead><tr>{head}</tr></thead>\n<tbody>',
            *rows,
            "</tbody></table></div>",
        )
    )


def _row(row: SheetRow, sheet: Sheet, links: Links) -> str:
    level = (
        _level(row.points, sheet.most_points) if sheet.most_points else _level(row.robustness, 1.0)
    )
    earned = "" if row.earned is None else f' title="the runs have earned {in_words(row.earned)}"'
    cells = (
        f'<th class="student" scope="row">{clean(row.name)}</th>',
        f'<td class="number {level}"{earned}>{in_words(row.points)}</td>',
        f'<td class="number">{row.robustness:.0%}</td>',
        *(_cell(cell, column, row) for cell, column in zip(row.cells, sheet.columns, strict=True)),
        f"<td>{_reason(row, links)}</td>",
    )
    return f"<tr>{''.join(cells)}</tr>"


def _level(points: float, most: float) -> str:
    return "met" if points >= most else "part" if points else "missed"


def _cell(cell: Cell, column: Goal, row: SheetRow) -> str:
    # A goal without points is met or missed, too.
    level = "met" if row.runs and cell.met == row.runs else "part" if cell.met else "missed"
    if column.points < 0:
        level = "missed" if cell.met else "met"
    seeds = f"met in {cell.met} of {row.runs} runs" if row.runs > 1 else ""
    hint = "; ".join(filter(None, (seeds, cell.reason)))
    return f'<td class="number {level}" title="{clean(hint)}">{in_words(cell.points)}</td>'


def _reason(row: SheetRow, links: Links) -> str:
    found = [f'<div class="comment">{clean(row.comment)}</div>'] if row.comment else []
    if row.earned is not None:
        found.append(
            f'<div class="soft">set by the tutor; the runs have earned {in_words(row.earned)}</div>'
        )
    found += [clean(row.reason)] if row.reason else []
    if row.line:
        found.append(f"<br>line {row.line}: <code>{clean(row.source_line)}</code>")
    for world in dict.fromkeys(outcome.world for outcome in row.outcomes):
        reports: dict[str, list[int]] = {}
        for seed in (outcome.seed for outcome in row.outcomes if outcome.world == world):
            if path := links.get((row.name, world, seed)):
                reports.setdefault(path, []).append(seed)
        if reports:
            shown = ", ".join(
                f'<a href="{quote(path)}">{_ranges(seeds)}</a>' for path, seeds in reports.items()
            )
            where = f" {clean(world)}" if world else ""
            found.append(f'<div class="soft">reports of runs{where} by seed: {shown}</div>')
    if row.stopped_early:
        found.append('<div class="soft">not run with further seeds</div>')
    if row.error:
        found.append(f"<details><summary>error</summary><pre>{clean(row.error)}</pre></details>")
    return "".join(found)


def _ranges(seeds: Sequence[int]) -> str:
    """Return ascending numbers with runs of them as ranges, such as `0, 3–5`."""
    found: list[list[int]] = []
    for seed in seeds:
        if found and seed == found[-1][-1] + 1:
            found[-1].append(seed)
        else:
            found.append([seed])
    return ", ".join(f"{one[0]}–{one[-1]}" if len(one) > 1 else str(one[0]) for one in found)


def reports_folder(file: Path) -> Path:
    """Return the folder of the reports that the page in a file links to."""
    return file.with_name(f"{file.stem}-runs")
