"""What the bands of a long log cost in the shell."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from pathlib import Path

from tests.bench.figures import Figure
from tests.bench.longlogs import MILLION, samples, written
from tests.bench.processes import command_used
from tests.bench.references import Ratio, start_cpu_s
from tests.bench.sampling import Effort, in_turns

ROWS = MILLION


def bands(effort: Effort) -> Iterator[Figure]:
    """Yield CPU and memory of `log bands` for a log with a band every 18 rows."""
    with tempfile.TemporaryDirectory() as folder:
        path = written(samples(ROWS), Path(folder) / "log.csv")
        used = []

        def printed_cpu_s() -> float:
            used.append(command_used("log", "bands", str(path)))
            return used[-1].cpu_s

        taken = in_turns(printed_cpu_s, start_cpu_s, effort)
    ratio = Ratio(taken.ratio, "x python -c pass")
    yield Figure(f"log bands, {ROWS:,} rows", taken.value, "s CPU", most=200, ratio=ratio)
    yield Figure(
        f"log bands, {ROWS:,} rows: memory", max(one.peak_mb for one in used), "MB", most=400
    )
