"""The charts of the analyser, with pixels where the terminal can."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.app.app_help import until
from tests.app.wires import on_wire, until_quiet
from tests.terminal.pixel_help import ANSWERS, drawn_by, on_canvas, part_of, seen_on
from tuisim.analysis.source import LogRequest
from tuisim.app.analyser.app import Analyser, AnalyserApp
from tuisim.app.analyser.chart import LogChart
from tuisim.app.plot_view import PlotView
from tuisim.pictures.charts.traces import TRACE_COLORS
from tuisim.terminal.picture_options import Protocol
from tuisim.terminal.queries import TerminalAnswered, parse_facts


@pytest.mark.quick_cases("kitty-one chart")
@pytest.mark.parametrize("facets", [False, True], ids=["one chart", "facets"])
@pytest.mark.parametrize("protocol", Protocol)
async def test_each_graphics_protocol_shows_the_analysers_drawn_charts(
    protocol: Protocol, facets: bool, tmp_path: Path
) -> None:
    file = tmp_path / "waves.csv"
    file.write_text(
        "time,Sine,Steps\n"
        + "".join(f"{at},{np.sin(at / 9):.4f},{at // 20}\n" for at in range(200)),
        "utf-8",
    )
    async with on_wire(AnalyserApp(LogRequest(str(file))), "truecolor") as pilot:
        await until(
            pilot, lambda: isinstance(pilot.app.screen, Analyser) and pilot.app.screen.is_open
        )
        chart = pilot.app.screen.query_one(LogChart)
        chart.options.facets = facets
        pilot.app.post_message(TerminalAnswered(parse_facts(ANSWERS[protocol])))
        view = chart.query_one(PlotView)
        await until(pilot, lambda: view._tiles is not None)
        await until_quiet(pilot)
        seen = part_of(seen_on(pilot), view)
        drawn = drawn_by(view, protocol)
        assert np.array_equal(on_canvas(view, seen), on_canvas(view, drawn))
        assert len(chart._pictures) == 1 + facets
        for rgb in TRACE_COLORS[:2]:
            # Channels of sixel are percentages.
            assert (np.abs(on_canvas(view, drawn).astype(int) - rgb) < 3).all(axis=2).sum() > 100, (
                rgb
            )
