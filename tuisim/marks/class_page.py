"""The sections of a class's page that are about the class as a whole, as HTML."""

from __future__ import annotations

from collections.abc import Sequence

from tuisim.analysis.report import paragraph, section, table
from tuisim.charts.files import clean
from tuisim.marks.copies import LEAST_TOKENS, Similar
from tuisim.marks.sheet import Sheet, in_words
from tuisim.marks.statistics import GoalStatistics, distribution, goal_statistics

STYLE = """\
.bars { display: flex; align-items: flex-end; gap: 2px; height: 5.5rem; max-width: 34rem; }
.bars div { flex: 1; display: flex; flex-direction: column; justify-content: flex-end; height: 100%;
  text-align: center; font-size: .75rem; color: var(--soft); }
.bars i { display: block; background: var(--soft); min-height: 1px; opacity: .55; }
meter { width: 7rem; }
.goals tbody th { white-space: normal; overflow-wrap: break-word; max-width: 10rem; }
.goals td:nth-child(2), .goals td:last-child { min-width: 12rem; }
@media (max-width: 45rem) {
  .goals thead { display: none; }
  .goals, .goals tbody, .goals tr, .goals tbody th, .goals td { display: block; max-width: none; border: 0; padding: 0;
    text-align: left; }
  .goals tr { border-top: 1px solid var(--rule); padding: .5rem 0; }
  .goals td:nth-child(3)::before { content: "points: "; }
  .goals td:nth-child(4)::before { content: "mean: "; }
  .goals td:nth-child(5)::before { content: "met by "; }
}
"""


def goals_section(sheet: Sheet) -> str:
    """Return how often each goal was met, and why it was missed."""
    heads = ("goal", "", "points", "mean", "met by", "", "missed, because")
    head = "".join(f'<th class="name">{clean(text)}</th>' for text in heads)
    rows = "".join(_goal(one, len(sheet.rows)) for one in goal_statistics(sheet))
    shown = f'<div class="wide"><table class="goals"><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table></div>'
    return section("Goals", shown)


def _goal(one: GoalStatistics, students: int) -> str:
    reasons = "".join(f"<li>{count} × {clean(reason)}</li>" for reason, count in one.reasons)
    met = f"{one.met} of {students}" + (f", {one.partly} in some runs" if one.partly else "")
    cells = (
        f'<th scope="row" class="name">{clean(one.goal.name)}</th>',
        f"<td>{clean(one.goal.say)}</td>",
        f'<td class="number">{in_words(one.goal.points)}</td>',
        f'<td class="number">{in_words(one.mean)}</td>',
        f'<td class="name">{met}</td>',
        f'<td><meter min="0" max="{max(students, 1)}" value="{one.met}">{met}</meter></td>',
        f"<td><ul>{reasons}</ul></td>" if reasons else "<td></td>",
    )
    return f"<tr>{''.join(cells)}</tr>"


def points_section(sheet: Sheet) -> str:
    """Return how many students have how many points; empty for fewer than three students."""
    parts = distribution(sheet)
    if len(sheet.rows) < 3 or not parts:
        return ""
    most = max(count for *_, count in parts)
    bars = "".join(
        f'<div title="{in_words(low)} to {in_words(high)} points: {count}">{count or ""}'
        f'<i style="height: {100 * count / most:.0f}%"></i>{in_words(low)}–{in_words(high)}</div>'
        for low, high, count in parts
    )
    return section(
        "Points", f'<div class="bars">{bars}</div>', paragraph("Students by points.", soft=True)
    )


def similar_section(found: Similar | None) -> str:
    """Return which programs resemble each other; empty if nothing was compared."""
    if found is None or found.compared < 2:
        return ""
    parts = [
        paragraph(
            "Programs that resemble each other, for you to look at: a small task has few solutions, and students may "
            "have worked together. Comments and blank lines do not count.",
            soft=True,
        )
    ]
    groups = [[str(len(one.names)), ", ".join(one.names), _same(one.same)] for one in found.groups]
    heads = ("", "equal but for names, numbers and texts", "of these equal to the letter")
    parts.append(table(heads, groups, numbers=len(heads)))
    pairs = [[*pair.names, f"{pair.share:.0%}", str(pair.lines)] for pair in found.pairs]
    parts.append(table(("program", "and", "passages in common", "lines"), pairs, numbers=2))
    if not groups and not pairs:
        parts.append(
            paragraph(
                f"None, of {found.compared} programs with at least {LEAST_TOKENS} words and signs."
            )
        )
    return section("Similar programs", *parts)


def _same(groups: Sequence[Sequence[str]]) -> str:
    return "; ".join(" = ".join(names) for names in groups)
