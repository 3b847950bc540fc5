"""The vertical scales of a chart in cells: their labels, and the last value of each trace at the end of its line."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np
from rich.style import Style

from tuisim.base.data_class import dataclass
from tuisim.pictures.charts import axes
from tuisim.pictures.charts.axes import Limits, limit_drawn
from tuisim.pictures.charts.canvas import AXIS, BRAILLE, Curve, build_style
from tuisim.pictures.charts.scales import Scale, Scales
from tuisim.pictures.charts.traces import Trace
from tuisim.terminal.text_runs import Run

_MIN_WIDTH = 36
"""Narrower charts have no room on the right of the canvas."""
_MIN_COLUMNS = 22
"""What stands on the right does not make the canvas narrower: further scales come first, then the last values."""
_LONG = 9
"""Values with more characters than that are written with a power of ten."""
_PARTS = 2000
"""Last values are rounded to about such a part of their scale."""


@dataclass(frozen=True)
class CellScales:
    """The vertical scales of a chart in characters: the labels left, and the last values right of the canvas."""

    scales: Scales
    labels: tuple[dict[int, str], ...]
    """Labels by row: of the left scale, and of the scales on the right that have room."""
    styles: tuple[Style, ...]
    """Styles of the labels: the colour of the trace, if the scale is for one of several."""
    ends: dict[int, Run]
    """The last values by row."""
    ends_width: int
    margins: tuple[int, int] = (0, 0)
    """Columns on the left and the right of the canvas at least, so that charts below each other are in line."""

    @classmethod
    def build(
        cls,
        drawn: Sequence[Trace],
        width: int,
        rows: int,
        x_limits: Limits,
        zoomed: bool,
        margins: tuple[int, int] = (0, 0),
    ) -> CellScales:
        """Return the scales of traces for a chart.

        Args:
            drawn: The traces.
            width: Width of the chart in columns.
            rows: Height of its canvas.
            x_limits: Limits of the time axis.
            zoomed: Whether the scales fit the visible data.
            margins: Minimum columns left and right of the canvas.
        """
        scales = Scales.group([(trace.name, trace.values, trace.scale) for trace in drawn], zoomed)
        scales = Scales(
            _on_rows(scales.left, rows), tuple(_on_rows(scale, rows) for scale in scales.right)
        )
        labels = [_label_scale(scales.left, rows)]
        left = width - _measure_width(labels[0])
        for scale in scales.right:
            more = _label_scale(scale, rows)
            if left - _measure_width(more) < _MIN_COLUMNS:
                break
            left -= _measure_width(more)
            labels.append(more)
        ends, ends_width = _place_end_values(drawn, scales, rows, x_limits)
        if width < _MIN_WIDTH or left - ends_width < _MIN_COLUMNS:
            ends = {}
            ends_width = 0
        colors = {trace.name: build_style(trace.rgb) for trace in drawn}
        is_one_of_several = [
            bool(scales.right) and len(scale.names) == 1 for scale in (scales.left, *scales.right)
        ]
        visible = zip((scales.left, *scales.right), is_one_of_several, labels, strict=False)
        styles = tuple(colors[scale.names[0]] if is_one else AXIS for scale, is_one, _ in visible)
        return cls(scales, tuple(labels), styles, ends, ends_width, margins)

    @property
    def y_limits(self) -> Limits:
        """The limits of the left scale, to which all curves are drawn."""
        return self.scales.left.limits

    @cached_property
    def left_width(self) -> int:
        """The number of columns on the left of the canvas."""
        return max(_measure_width(self.labels[0]), self.margins[0])

    @cached_property
    def right_width(self) -> int:
        """The number of columns on the right of the canvas."""
        return max(self._right_used, self.margins[1])

    @cached_property
    def _right_used(self) -> int:
        return self.ends_width + sum(map(_measure_width, self.labels[1:]))

    def curve(self, trace: Trace, marks: bool) -> Curve:
        """Return a trace as a curve whose values are converted to the left scale.

        Args:
            trace: The trace.
            marks: Whether its points are drawn, with the trace's mark, in place of a line.
        """
        values = self.scales.on_left(trace.values, self.scales.find_scale(trace.name))
        return Curve(trace.times_s, values, trace.rgb, trace.mark if marks else BRAILLE)

    def frame_row(self, row: int, inside: list[Run]) -> list[Run]:
        """Return a row of the chart: the row of the canvas with labels on its left and last values on its right."""
        text = self.labels[0].get(row, "")
        line = [
            (text.rjust(self.left_width - 1), self.styles[0]),
            ("┤" if text else "│", AXIS),
            *inside,
        ]
        if self.ends_width:
            text, style = self.ends.get(row, ("", AXIS))
            # A blank keeps a value apart from the end of its line, whose dots would look like a colon.
            line.append((f" {text}".ljust(self.ends_width), style))
        for labels, style in zip(self.labels[1:], self.styles[1:], strict=True):
            text = labels.get(row, "")
            line += [("├" if text else "│", AXIS), (text.ljust(_measure_width(labels) - 1), style)]
        if more := self.right_width - self._right_used:
            line.append((" " * more, AXIS))
        return line


def _on_rows(scale: Scale, rows: int) -> Scale:
    return replace(scale, limits=axes.extend_limits(scale.ends, rows))


def _label_scale(scale: Scale, rows: int) -> dict[int, str]:
    """Return the labels of a scale by row; the uppermost one has the unit."""
    labels = axes.label_rows(scale.limits, rows)
    top = min(labels)
    return {**labels, top: labels[top] + scale.unit}


def _measure_width(labels: dict[int, str]) -> int:
    return max(map(len, labels.values())) + 1


def _place_end_values(
    drawn: Sequence[Trace], scales: Scales, rows: int, x_limits: Limits
) -> tuple[dict[int, Run], int]:
    """Return the last visible values of the traces by row, and their width in columns.

    Each value is in the row in which its line ends, or in a row next to that.
    """
    ends: list[tuple[int, Run]] = []
    width = 0
    for trace in drawn:
        scale = scales.find_scale(trace.name)
        value = trace.find_value(x_limits[1])
        if value is None:
            continue
        texts = [_round_value(end, scale) for end in (value, *scale.limits)]
        place = scales.on_left(limit_drawn(np.array([value])), scale)
        row = int(axes.measure_row(float(place[0]), scales.left.limits, rows))
        ends.append(
            (
                row,
                (
                    texts[0].rstrip("0").rstrip(".") + scale.unit
                    if "." in texts[0]
                    else texts[0] + scale.unit,
                    build_style(trace.rgb),
                ),
            )
        )
        # The labels of the limits count for the width, too, so that the canvas keeps its size while values come in.
        width = max(width, *(len(text + scale.unit) for text in texts))
    return _separate_rows(ends, rows), width + 1 if ends else 0


def _round_value(value: float, scale: Scale) -> str:
    low, high = scale.limits
    text = axes.label(value, axes.choose_step(high - low, _PARTS))
    return text if len(text) <= _LONG else f"{value:.4g}"


def _separate_rows(ends: Sequence[tuple[int, Run]], rows: int) -> dict[int, Run]:
    """Return texts by row, at most one in each; a text whose row is taken is moved to a row next to it, or left out.

    Equal texts of a row appear only once.

    Args:
        ends: For each text, the row in which it should be, and the text.
        rows: Number of rows.
    """
    taken: dict[int, Run] = {}
    row_of: dict[int, int] = {}
    for row, run in ends:
        near = [candidate for candidate in (row, row + 1, row - 1) if 0 <= candidate < rows]
        same = next(
            (
                candidate
                for candidate in near
                if candidate in taken and row_of[candidate] == row and taken[candidate][0] == run[0]
            ),
            None,
        )
        if same is not None:
            taken[same] = run[0], AXIS
        elif (
            free := next((candidate for candidate in near if candidate not in taken), None)
        ) is not None:
            taken[free], row_of[free] = run, row
    return taken
