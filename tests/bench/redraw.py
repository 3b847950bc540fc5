"""`python -m tests.bench.redraw ROWS`: print the CPU seconds of redrawing a chart of so many samples, as JSON."""

from __future__ import annotations

import json
import sys
import time
from statistics import median

import numpy as np

from tuisim.charts.text_chart import ChartPainter, ChartState
from tuisim.charts.traces import Traces

WIDTH, HEIGHT = 100, 30
TIMES = 21


def redraw_s(rows: int) -> list[float]:
    """Return what each of some redraws costs, with other limits every time, so that nothing can be kept."""
    times_s = np.arange(rows) * 0.01
    values = 50.0 + 40.0 * np.sin(times_s / 7.0) + np.random.default_rng(7).normal(0.0, 5.0, rows)
    traces, painter, used = Traces(), ChartPainter(), []
    traces.append("Colour", times_s.tolist(), values.tolist())
    for at in range(TIMES + 1):
        before = time.process_time()
        painter.paint(traces, ChartState(x_limits=(0.0, float(times_s[-1]) + at)), WIDTH, HEIGHT)
        used.append(time.process_time() - before)
    # The first one imports plotext.
    return used[1:]


if __name__ == "__main__":
    taken_s = redraw_s(int(sys.argv[1]))
    print(json.dumps({"median": median(taken_s), "worst": max(taken_s)}))
