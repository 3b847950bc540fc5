"""Alignment of runs: by time, by distance driven, or by an event in each run."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from tuisim.analysis.events import threshold_of
from tuisim.errors import LogError
from tuisim.logs.bands import driven_mm

if TYPE_CHECKING:
    from tuisim.logs.log import Log, Series
    from tuisim.runs.arrays import FloatArray

TIME, DISTANCE = "time", "distance"
FORM = "time, distance, or an event such as `Colour < 50`"


def aligned(log: Log, series: Sequence[Series], way: str) -> list[FloatArray | None]:
    """Return the x positions of the samples of each series; None: their times.

    Args:
        log: Where they come from.
        series: Variables of its runs.
        way: As `FORM` says.

    Raises:
        LogError: `way` is none, or the log cannot be aligned like that.
    """
    if way == TIME:
        return [None] * len(series)
    if way == DISTANCE:
        driven = [driven_mm(log, one) for one in series]
        if any(places is None for places in driven):
            raise LogError("no distances: the log has no x_mm and y_mm in each row", FORM)
        return driven
    event = threshold_of(way)
    if event is None:
        raise LogError(f"cannot align by {way!r}", FORM)
    found = {one.run: there[0].time_s for one in event.among(series) if (there := event.crossings(one))}
    if not found:
        raise LogError(f"no run comes to {way}", FORM)
    # A run in which it never happens stays where the earliest one is.
    return [one.time_s - found.get(one.run, min(found.values())) for one in series]
