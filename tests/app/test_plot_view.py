"""The chart with pixels, and with characters where it must be."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from textual.pilot import Pilot

from tests.app.app_help import lab, settings, until
from tests.app.wires import on_wire, until_quiet, wire_of
from tests.terminal.pixel_help import ANSWERS, answered, drawn_by, on_canvas, part_of, seen_on
from tuisim.app.app import LabApp
from tuisim.app.panels.chart import Chart
from tuisim.app.plot_view import PlotView
from tuisim.app.screenshot import collect_cells
from tuisim.terminal.picture_mode import Sharpness
from tuisim.terminal.picture_options import AUTO, CellSet, Protocol
from tuisim.terminal.queries import TerminalAnswered, parse_facts


def _fed(pilot: Pilot[Any], end_s: float) -> PlotView:
    """Show the chart with a point each tenth of a second, on a link that is fast however busy the machine is."""
    lab(pilot).picture_mode.is_slow = lambda: False
    times_s = np.arange(0.0, end_s, 0.1)
    chart = pilot.app.query_one(Chart)
    chart.clear()
    chart.append("Colour", times_s.tolist(), (50 + 40 * np.sin(times_s)).tolist())
    chart.focus()
    return chart.query_one(PlotView)


@pytest.mark.quick_cases("kitty")
@pytest.mark.parametrize("protocol", Protocol)
async def test_the_chart_is_what_was_drawn(protocol: Protocol) -> None:
    async with on_wire(LabApp(settings(panels_on=frozenset({"chart"}))), "truecolor") as pilot:
        await answered(pilot, ANSWERS[protocol])
        view = _fed(pilot, 7.9)
        await until(
            pilot, lambda: view._tiles is not None and not pilot.app.query_one(Chart)._dirty
        )
        await until_quiet(pilot)
        # With other limits everything would move.
        chart = pilot.app.query_one(Chart)
        chart.action_freeze()
        await until(pilot, lambda: not chart._dirty)
        await until_quiet(pilot)
        before = wire_of(pilot).kilobytes
        chart.append("Colour", [7.75], [20.0])
        # It is drawn a few times a second only.
        await until(pilot, lambda: not chart._dirty)
        await until_quiet(pilot)
        seen = part_of(seen_on(pilot), view)
        drawn = drawn_by(view, protocol)
        assert np.array_equal(on_canvas(view, seen), on_canvas(view, drawn))
        assert np.unique(on_canvas(view, drawn).reshape(-1, 3), axis=0).shape[0] > 4
        assert 0 < wire_of(pilot).kilobytes - before < before / 10


def _characters(pilot: Pilot[Any], view: PlotView) -> str:
    """Return the characters of a screenshot where a chart is."""
    x, y, width, height = view.content_region
    lines = ["".join(text for text, _ in row) for row in collect_cells(pilot.app)]
    return "".join(line[x : x + width] for line in lines[y : y + height])


@pytest.mark.slow
async def test_a_screenshot_shows_a_pixel_chart_in_characters() -> None:
    async with on_wire(LabApp(settings(panels_on=frozenset({"chart"}))), "truecolor") as pilot:
        await answered(pilot, "\x1b[?1;2c")
        view = _fed(pilot, 5.0)
        await until_quiet(pilot)
        expected = _characters(pilot, view)
        pilot.app.post_message(TerminalAnswered(parse_facts(ANSWERS[Protocol.SIXEL])))
        await until(pilot, lambda: view._tiles is not None)
        await until_quiet(pilot)
        assert _characters(pilot, view) == expected


def _is_of_pixels(view: PlotView) -> bool:
    return view._tiles is not None


@pytest.mark.slow
async def test_a_chart_falls_back_to_characters_and_returns_to_pixels(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    async with on_wire(LabApp(settings(panels_on=frozenset({"chart"}))), "truecolor") as pilot:
        await answered(pilot, ANSWERS[Protocol.KITTY])
        view = _fed(pilot, 5.0)
        await until(pilot, lambda: view._tiles is not None)
        # On a busy machine the link is slow.
        lab(pilot).picture_mode.is_slow = lambda: False
        lab(pilot).choose_cells(CellSet.HALF)
        assert not _is_of_pixels(view)
        lab(pilot).choose_cells(AUTO)
        assert _is_of_pixels(view)
        lab(pilot).picture_mode.is_slow = lambda: True
        with monkeypatch.context() as patch:
            patch.setattr(Sharpness, "is_still", False)
            pilot.app.query_one(Chart).append("Colour", [5.0], [0.0])
            await until(pilot, lambda: view._tiles is None)
        await until(pilot, lambda: view._tiles is not None)
