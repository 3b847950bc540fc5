"""The pictures of runs: what is drawn of many samples, and of a pen that is put down and lifted."""

from __future__ import annotations

import numpy as np

from tests.running import Run
from tuisim.core.spec import PenSpec
from tuisim.datalog.samples import Sample
from tuisim.figures import CHART_SIZE, chart_picture, pen_trace

BLUE = (31, 119, 180)


def samples(count: int, peak: float) -> list[Sample]:
    return [Sample("Grey", peak if at == count // 3 else at % 7, at / count, at, at, 1) for at in range(count)]


def blue_rows(count: int, peak: float) -> set[int]:
    pixels = np.asarray(chart_picture(samples(count, peak)))[30:]
    return set(np.flatnonzero((pixels == BLUE).all(axis=2).any(axis=1)).tolist())


def test_a_single_peak_among_many_samples_is_seen() -> None:
    # From the frame's upper edge to its lower one, as of few samples.
    rows = blue_rows(50_000, 100.0)
    assert rows == blue_rows(900, 100.0)
    assert len(rows) > CHART_SIZE[1] / 2


def test_a_trace_is_as_long_as_the_pen_is_down(run: Run) -> None:
    program = "tank_drive.on_for_seconds(SpeedPercent(50), SpeedPercent(50), 1)"
    for down, parts in ((False, 0), (True, 1)):
        done = run(program, pen=PenSpec(down=down), background="Empty_Map")
        trace = pen_trace(done.run.spec, done.run.telemetry.array())
        assert len(trace.lines) == parts
    (line,) = trace.lines
    start, end = done.run.telemetry.record(0), done.run.telemetry.last()
    assert end is not None
    assert [round(3 * x) for x, _ in (line[0], line[-1])] == [round(start.x_mm), round(end.x_mm)]
    assert len(line) < done.run.telemetry.count
