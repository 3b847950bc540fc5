"""Logs that are too long to be searched through at once."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from tests.app.analyser.logs import model_of
from tests.app.app_help import until
from tuisim.analysis.source import LogRequest
from tuisim.app.analyser.app import Analyser, AnalyserApp
from tuisim.app.analyser.panes import pane_lines
from tuisim.charts.text_runs import Line
from tuisim.logs.columns import guess_columns
from tuisim.logs.log import Log

LEVELS = (100.0, 86.27, 50.2, 0.0)


def stepped(rows: int, band_samples: int) -> pa.Table:
    values = np.array(LEVELS)[np.arange(rows) // band_samples % len(LEVELS)]
    return pa.table({"time": np.arange(rows) / 100.0, "Colour": values})


def text_of(lines: list[Line]) -> list[str]:
    return ["".join(part for part, _ in line) for line in lines]


def test_of_many_bands_those_around_the_chosen_one_are_shown() -> None:
    table = stepped(12_000, 8)
    model = model_of(Log("test", table, guess_columns(table)))
    model.find_bands(model.unsearched())
    assert len(model.bands()) == 1500
    shown = text_of(pane_lines("bands", model, 1250, 80, 20))
    numbers = [int(line.split()[1]) for line in shown[1:12]]
    assert 1251 in numbers and numbers == list(range(numbers[0], numbers[0] + 11))
    assert "4 levels" in " ".join(shown)


@pytest.mark.slow
async def test_a_long_log_is_searched_beside_the_screen(tmp_path: Path) -> None:
    pq.write_table(stepped(30_000, 3000), tmp_path / "long.parquet")
    async with AnalyserApp(LogRequest(file=str(tmp_path / "long.parquet"))).run_test(size=(120, 40)) as pilot:
        screen = pilot.app.screen
        await until(pilot, lambda: isinstance(pilot.app.screen, Analyser) and pilot.app.screen.is_open)
        screen = pilot.app.screen
        assert isinstance(screen, Analyser)
        await pilot.press("b")
        assert screen.is_open and not screen.model.bands()
        await until(pilot, lambda: screen.is_open and len(screen.model.bands()) == 10)
