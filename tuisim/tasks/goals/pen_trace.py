"""The condition on what the pen draws."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from tuisim.engine.core.spec import PenSpec
from tuisim.engine.core.tick_record import FLAG_PEN_DOWN
from tuisim.tasks.goals import picture
from tuisim.tasks.goals.evidence import Evidence, EvidencePoint, EvidenceSpan
from tuisim.tasks.goals.found import Finding, share_words
from tuisim.tasks.goals.spec import DrawCondition

if TYPE_CHECKING:
    import numpy as np

    Array = np.ndarray[Any, Any]


def find_drawn(condition: DrawCondition, evidence: Evidence, span: EvidenceSpan) -> Finding:
    """Find out at the end of a span whether the drawing is near the picture."""
    import numpy as np

    records = evidence.records[span.ticks]
    points, ticks = _sample_strokes(records, evidence.spec.robot.pen, condition)
    if not len(points):
        return Finding(None, "The pen drew nothing.")
    cells = picture.list_cells(condition)
    covered, near = picture.compare(cells, points, condition.within_mm)
    drawn = float(covered.mean())
    on_picture = float(near.mean())
    reasons = []
    line = 0
    if drawn < condition.share:
        x_mm, y_mm = picture.compute_centres_mm(cells[~covered][:1], condition.within_mm)[0]
        reasons.append(
            f"{share_words(drawn)} of the picture is drawn, not the part at x {x_mm:.0f}, y {y_mm:.0f} mm"
        )
    if on_picture < condition.share:
        off = int(np.argmin(near))
        tick = span.first_tick + int(ticks[off])
        (x_mm, y_mm), line = points[off], evidence.line(EvidencePoint(tick))
        reasons.append(
            f"{share_words(on_picture)} of the drawing is on the picture, it leaves it at x {x_mm:.0f}, "
            f"y {y_mm:.0f} mm at {evidence.time_words(tick)}"
        )
    if reasons:
        return Finding(
            None, f"{' and '.join(reasons)}; {share_words(condition.share)} are needed.", line
        )
    return Finding(evidence.last if span.over else span.stop)


def _sample_strokes(records: Array, pen: PenSpec, condition: DrawCondition) -> tuple[Array, Array]:
    """Return points on what the pen drew, shape (n, 2) in mm, at most a cell apart, and the tick of each."""
    import numpy as np

    down = (records["flags"] & FLAG_PEN_DOWN) != 0
    if not down.any():
        return np.empty((0, 2)), np.empty(0, np.int64)
    from tuisim.engine.runs.arrays import compute_world_points_mm

    pen_mm = np.column_stack(compute_world_points_mm(records, pen.x_mm, pen.y_mm))
    # A robot that was moved by hand draws no line.
    joined = down[1:] & down[:-1] & (np.diff(records["actions"].astype("i4")) == 0)
    way_mm = np.where(joined, np.hypot(*np.diff(pen_mm, axis=0).T), 0.0)
    count = np.ceil(way_mm / picture.compute_cell_mm(condition.within_mm)).astype(np.int64)
    ends = np.repeat(np.arange(1, len(pen_mm)), count)
    number = np.arange(len(ends)) - np.repeat(np.cumsum(count) - count, count)
    part = ((number + 1) / np.repeat(np.maximum(count, 1), count))[:, None]
    between = pen_mm[ends - 1] * (1 - part) + pen_mm[ends] * part
    touched = np.flatnonzero(down & np.concatenate(([True], ~joined)))
    points = np.concatenate((pen_mm[touched], between))
    ticks = np.concatenate((touched, ends))
    order = np.argsort(ticks, kind="stable")
    return points[order], ticks[order]
