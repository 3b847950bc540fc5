"""The sensor arrays panel: where the discs are, and the lines beside each."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

from rich.color import Color
from rich.style import Style

from tuisim.base import palette
from tuisim.engine.core.sensors.color import ColorReading
from tuisim.pictures.scene.discs import DiscFace
from tuisim.programs.facts import read_facts
from tuisim.terminal.text_runs import Line, Run, cut

if TYPE_CHECKING:
    from tuisim.app.snapshot import Snapshot

FULL_COLS, LARGE_COLS = 20, 40
"""Columns of a disc with one or two cells per mm; a size between them would show no more."""
_LEAST_TEXT_COLS, _MOST_TEXT_COLS = 13, 24
_MAX_LINES = 5
_FAIR_ROWS = 6
"""A disc is not made lower than this for a second line of text."""

UP_WORDS = "up is up on the mat"
"""Words in the frame if it shows no names."""

_RINGS_ARE = "in→out"
_RING_DIGITS = 3
"""What the means of the rings are, in their order, and the digits of the longest."""

_LABEL, _VALUE, _UNIT = (
    Style(color=palette.LABEL),
    Style(color=palette.WHITE, bold=True),
    Style(color=palette.SOFT),
)
_FILLED, _REST = Style(color=palette.BLUE), Style(color=palette.LINE)
_LIMIT = Style(color=palette.YELLOW, bold=True)


class Arrangement(NamedTuple):
    """The sizes of the discs in the sensor arrays panel, and where their lines are."""

    across: bool
    """Whether the sensors stand side by side, and not one above the other."""
    below: bool
    """Whether the lines of each are below its disc, and not at its right."""
    disc_cols: int
    """Columns of a disc; it has half as many rows."""
    text_cols: int
    text_rows: int


def arrange_discs(count: int, cols: int, rows: int) -> Arrangement:
    """Return the arrangement with the largest discs; the sensors are side by side if there is a choice.

    Args:
        count: How many sensors.
        cols: Columns of the panel.
        rows: Its rows.
    """
    count = max(count, 1)
    arrangements = []
    for across in (True, False):
        wide, high = (cols // count, rows) if across else (cols, rows // count)
        lines = _count_lines_below(wide, high)
        arrangements.append(
            Arrangement(across, True, _count_disc_columns(wide, 2 * (high - lines)), wide, lines)
        )
        text = min(max(wide - 1 - 2 * high, _LEAST_TEXT_COLS), _MOST_TEXT_COLS)
        beside = _count_disc_columns(wide - 1 - text, 2 * high)
        arrangements.append(
            Arrangement(across, False, beside, min(wide - 1 - beside, _MOST_TEXT_COLS), high)
        )
    return max(
        arrangements,
        key=lambda arrangement: (arrangement.disc_cols, arrangement.text_rows * arrangement.below),
    )


def _count_disc_columns(cols: int, high_cols: int) -> int:
    """Return the largest width in columns of a disc that fits an area.

    Args:
        cols: Width of the area in columns.
        high_cols: Height of the area in columns; a row is as high as two columns are wide.
    """
    side = max(min(cols, high_cols), 0)
    return LARGE_COLS if side >= LARGE_COLS else min(side, FULL_COLS)


def _count_lines_below(cols: int, rows: int) -> int:
    if rows < _MIN_ROWS:
        return 0
    spare = rows - (min(cols, FULL_COLS) + 1) // 2
    return min(max(rows - _FAIR_ROWS, spare, 1), _MAX_LINES)


_MIN_ROWS = 4


def find_asked_lines(now: Snapshot, before: frozenset[int]) -> frozenset[int]:
    """Return the lines of the program whose comparisons of readings with thresholds matter at an instant.

    These are the lines with thresholds in the loop that is executed; before a run, they are all lines with thresholds.
    While a function runs, the text of the program does not tell in which loop it was called: lines outside the function
    are then in the result if they are in `before`.

    Args:
        now: The instant.
        before: The result for the instant shown before.
    """
    if now.program is None:
        return frozenset()
    facts = read_facts(now.program)
    thresholds = facts.find_thresholds(now.spec.robot).values()
    lines = frozenset(threshold.line for every in thresholds for threshold in every)
    if not now.line:
        return lines
    function, _ = facts.find_place(now.line)
    places = {line: facts.find_place(line) for line in lines}
    return frozenset(
        line
        for line, (own, asking) in places.items()
        if (line in before if function not in (0, own) else now.line in asking)
    )


def build_face_lines(face: DiscFace, width: int, rows: int, *, has_limits: bool) -> list[Line]:
    """Return the lines about a sensor beside its disc; if there are few rows, the most useful ones.

    Args:
        face: What the sensor sees.
        width: Columns.
        rows: The largest number of lines.
        has_limits: Whether to include a line for thresholds, because at least one sensor has some.
    """
    lines = [_build_value_line(face, width), _scale_line(face, width)]
    lines += [[(cut(face.limit_words(width), width), _LIMIT)]] if has_limits else []
    rings = _ring_lines(face, width)
    # The rings are shown completely or not at all, since their label is of no use without the numbers.
    lines += rings if len(lines) + len(rings) <= rows else []
    return [[(cut(face.name, width), _LABEL)], *lines] if rows > len(lines) else lines[:rows]


def _build_value_line(face: DiscFace, width: int) -> Line:
    value = face.value_words
    name = face.seen.name
    swatch = build_swatch(face.seen)
    for middle in (
        [(" ", _UNIT), swatch, (" color", _UNIT)],
        [(" color", _UNIT)],
        [(" ", _UNIT), swatch],
    ):
        if len(value) + sum(len(text) for text, _ in middle) + 1 + len(name) <= width:
            return [(value, _VALUE), *middle, (f" {name}", _VALUE)]
    close = value.replace(" %", "%").replace("mean ", "")
    short = close.partition(" of ")[0]
    fits = (
        text for text in (f"{close} {name}", f"{short} {name}", close, short) if len(text) <= width
    )
    return [(next(fits, cut(short, width)), _VALUE)]


def build_swatch(seen: ColorReading) -> Run:
    """Return two cells in the colour that a sensor sees; an underline shows them on a background of that colour."""
    return "  ", Style(color=palette.LABEL, bgcolor=Color.from_rgb(*seen.rgb), underline=True)


def _scale_line(face: DiscFace, width: int) -> Line:
    """Return a scale from black to white that is filled up to the program's reading, with marks at the thresholds."""
    filled = round(min(max(face.share, 0), 1) * width)
    cells = [("━", _FILLED) if column < filled else ("─", _REST) for column in range(width)]
    for share in face.limit_shares:
        cells[min(int(share * width), width - 1)] = "┃", _LIMIT
    return cells


def _ring_lines(face: DiscFace, width: int) -> list[Line]:
    """Return a line with a label and the mean value of each ring of a sensor's area.

    If the width is too small for this, the label and the values are in two lines.
    """
    values: Line = [
        part
        for word in face.ring_words
        for part in ((word.rjust(_RING_DIGITS), _VALUE), (" ", _UNIT))
    ][:-1]
    longest = len(_RINGS_ARE) + len(face.ring_words) * (1 + _RING_DIGITS)
    return (
        [[(_RINGS_ARE, _LABEL), (" ", _UNIT), *values]]
        if longest <= width
        else [[(_RINGS_ARE, _LABEL)], values]
    )


def list_border_names(names: Sequence[str], where: Arrangement, *, has_limits: bool) -> str:
    """Return the text for the frame of the panel: the names of the sensors.

    If there is only one sensor, or the lines beside the discs have the names, the text says instead how the discs are
    turned: `UP_WORDS`.

    Args:
        names: The names of the sensors.
        where: The arrangement of the discs.
        has_limits: Whether there is a line for thresholds.
    """
    if len(names) < 2 or where.text_rows > _MAX_LINES - 2 + has_limits:
        return UP_WORDS
    return (" │ " if where.across else " above ").join(names)
