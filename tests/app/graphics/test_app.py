"""The app draws the world, the sensor arrays and charts with pixels where the terminal can."""

from __future__ import annotations

import gc
import re
from pathlib import Path
from typing import Any
from weakref import ref

import numpy as np
import pytest
from textual.geometry import Region
from textual.pilot import Pilot

from tests.app.app_help import lab, ready, settings, until
from tests.app.graphics.decoder import PixelTerminal
from tests.app.wires import on_wire, until_quiet, wire_of
from tuisim.analysis.source import LogRequest
from tuisim.app.analyser.app import Analyser, AnalyserApp
from tuisim.app.analyser.chart import LogChart
from tuisim.app.app import LabApp
from tuisim.app.panels.arrays import Arrays
from tuisim.app.panels.chart import Chart
from tuisim.app.panels.world import WorldView
from tuisim.app.terminal.cell_view import PixelView
from tuisim.app.terminal.picture_mode import Sharpness
from tuisim.app.terminal.plot_view import PlotView
from tuisim.app.terminal.queries import ATTRIBUTES_QUERY, CELL_SIZE_QUERY, KITTY_QUESTIONS, TerminalAnswered, facts_in
from tuisim.app.terminal.screenshot import screen_cells
from tuisim.charts.traces import TRACE_COLORS
from tuisim.config.options import AUTO, CellSet, Protocol

CELL_PX = 8, 16
ANSWERS = {
    Protocol.SIXEL: "\x1bP>|XTerm(379)\x1b\\\x1b[6;16;8t\x1b[?63;4c",
    Protocol.ITERM: "\x1bP>|iTerm2 3.5.4\x1b\\\x1b[6;16;8t\x1b[?64;4c",
    Protocol.KITTY: "\x1bP>|kitty(0.36.4)\x1b\\\x1b[6;16;8t\x1b[?62;52;c\x1b_Gi=31;OK\x1b\\",
}


def _seen(pilot: Pilot[Any]) -> PixelTerminal:
    terminal = PixelTerminal(40, 120, CELL_PX)
    terminal.feed("".join(wire_of(pilot).sent))
    return terminal


def _part(terminal: PixelTerminal, view: PixelView | PlotView) -> np.ndarray[Any, Any]:
    x, y, width, height = view.content_region
    return terminal.pixels[y * 16 : (y + height) * 16, x * 8 : (x + width) * 8]


def _drawn(view: PixelView | PlotView, protocol: Protocol) -> np.ndarray[Any, Any]:
    assert view._tiles is not None
    points = view._tiles._points
    return np.rint(np.rint(points * (100 / 255)) * 255 / 100).astype(np.uint8) if protocol == "sixel" else points


async def _sharp(pilot: Pilot[Any], view: PixelView) -> None:
    """Wait until a picture is drawn with pixels: while it moves and the link may be slow, it need not be."""
    await until(pilot, lambda: view._tiles is not None and not view._tiles.is_coarse)
    await until_quiet(pilot)


async def _answered(pilot: Pilot[Any], answers: str) -> None:
    await ready(pilot)
    await until_quiet(pilot)
    pilot.app.post_message(TerminalAnswered(facts_in(answers)))
    await until_quiet(pilot)


@pytest.mark.quick_cases("kitty")
@pytest.mark.parametrize("protocol", Protocol)
async def test_what_the_terminal_shows_is_what_was_drawn(protocol: Protocol) -> None:
    async with on_wire(LabApp(settings()), "truecolor") as pilot:
        await _answered(pilot, ANSWERS[protocol])
        for key in ("right", "a", "a", "up"):
            await pilot.press(key)
        for view in (pilot.app.query_one(WorldView), pilot.app.query_one(Arrays).query_one(PixelView)):
            await _sharp(pilot, view)
            assert np.array_equal(_part(_seen(pilot), view), _drawn(view, protocol))


def _fed(pilot: Pilot[Any], end_s: float) -> PlotView:
    """Show the chart with a point each tenth of a second, on a link that is fast however busy the machine is."""
    lab(pilot).picture_mode.is_slow = lambda: False
    times_s = np.arange(0.0, end_s, 0.1)
    chart = pilot.app.query_one(Chart)
    chart.clear()
    chart.append("Colour", times_s.tolist(), (50 + 40 * np.sin(times_s)).tolist())
    chart.focus()
    return chart.query_one(PlotView)


def _on_canvas(view: PlotView, points: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """Return what an image of the view shows where it has a chart."""
    rows = [points[y * 16 : y * 16 + 16, 8 * left : 8 * right] for y, (left, right) in view._spans.items()]
    return np.concatenate(rows)


@pytest.mark.quick_cases("kitty")
@pytest.mark.parametrize("protocol", Protocol)
async def test_the_chart_is_what_was_drawn(protocol: Protocol) -> None:
    async with on_wire(LabApp(settings(panels_on=frozenset({"chart"}))), "truecolor") as pilot:
        await _answered(pilot, ANSWERS[protocol])
        view = _fed(pilot, 7.9)
        await until(pilot, lambda: view._tiles is not None and not pilot.app.query_one(Chart)._dirty)
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
        seen, drawn = _part(_seen(pilot), view), _drawn(view, protocol)
        assert np.array_equal(_on_canvas(view, seen), _on_canvas(view, drawn))
        assert np.unique(_on_canvas(view, drawn).reshape(-1, 3), axis=0).shape[0] > 4
        assert 0 < wire_of(pilot).kilobytes - before < before / 10


@pytest.mark.quick_cases("kitty-one chart")
@pytest.mark.parametrize("facets", [False, True], ids=["one chart", "facets"])
@pytest.mark.parametrize("protocol", Protocol)
async def test_the_charts_of_the_analyser_are_what_was_drawn(protocol: Protocol, facets: bool, tmp_path: Path) -> None:
    file = tmp_path / "waves.csv"
    file.write_text(
        "time,Sine,Steps\n" + "".join(f"{at},{np.sin(at / 9):.4f},{at // 20}\n" for at in range(200)), "utf-8"
    )
    async with on_wire(AnalyserApp(LogRequest(str(file))), "truecolor") as pilot:
        await until(pilot, lambda: isinstance(pilot.app.screen, Analyser) and pilot.app.screen.is_open)
        chart = pilot.app.screen.query_one(LogChart)
        chart.options.facets = facets
        pilot.app.post_message(TerminalAnswered(facts_in(ANSWERS[protocol])))
        view = chart.query_one(PlotView)
        await until(pilot, lambda: view._tiles is not None)
        await until_quiet(pilot)
        seen, drawn = _part(_seen(pilot), view), _drawn(view, protocol)
        assert np.array_equal(_on_canvas(view, seen), _on_canvas(view, drawn))
        assert len(chart._pictures) == 1 + facets
        for rgb in TRACE_COLORS[:2]:
            # Channels of sixel are percentages.
            assert (np.abs(_on_canvas(view, drawn).astype(int) - rgb) < 3).all(axis=2).sum() > 100, rgb


def _characters(pilot: Pilot[Any], view: PlotView) -> str:
    """Return the characters of a screenshot where a chart is."""
    x, y, width, height = view.content_region
    lines = ["".join(text for text, _ in row) for row in screen_cells(pilot.app)]
    return "".join(line[x : x + width] for line in lines[y : y + height])


@pytest.mark.slow
async def test_a_screenshot_of_a_chart_has_its_characters() -> None:
    async with on_wire(LabApp(settings(panels_on=frozenset({"chart"}))), "truecolor") as pilot:
        await _answered(pilot, "\x1b[?1;2c")
        view = _fed(pilot, 5.0)
        await until_quiet(pilot)
        expected = _characters(pilot, view)
        pilot.app.post_message(TerminalAnswered(facts_in(ANSWERS[Protocol.SIXEL])))
        await until(pilot, lambda: view._tiles is not None)
        await until_quiet(pilot)
        assert _characters(pilot, view) == expected


def _is_of_pixels(view: PlotView) -> bool:
    return view._tiles is not None


@pytest.mark.slow
async def test_a_chart_falls_back_to_characters_and_returns_to_pixels(monkeypatch: pytest.MonkeyPatch) -> None:
    async with on_wire(LabApp(settings(panels_on=frozenset({"chart"}))), "truecolor") as pilot:
        await _answered(pilot, ANSWERS[Protocol.KITTY])
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


def _around(shown: PixelView, hidden: Region, points: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """Return an image of a view without the cells that something hides."""
    seen = points.copy()
    x, y, width, height = hidden.translate(-shown.content_region.offset)
    seen[max(y, 0) * 16 : max(y + height, 0) * 16, max(x, 0) * 8 : max(x + width, 0) * 8] = 0
    return seen


@pytest.mark.slow
@pytest.mark.parametrize("protocol", Protocol)
async def test_a_dialog_hides_a_part_of_the_picture_and_gives_it_back(protocol: Protocol) -> None:
    async with on_wire(LabApp(settings()), "truecolor") as pilot:
        await _answered(pilot, ANSWERS[protocol])
        world = pilot.app.query_one(WorldView)
        await _sharp(pilot, world)
        await pilot.press("b")
        await until_quiet(pilot)
        frame = pilot.app.screen.query_one(".dialog").region
        seen, drawn = _part(_seen(pilot), world), _drawn(world, protocol)
        assert frame.overlaps(world.content_region)
        assert not np.array_equal(seen, drawn)
        assert np.array_equal(_around(world, frame, seen), _around(world, frame, drawn))
        await pilot.press("escape")
        await _sharp(pilot, world)
        assert np.array_equal(_part(_seen(pilot), world), _drawn(world, protocol))


@pytest.mark.slow
async def test_a_resized_terminal_is_asked_for_the_size_of_its_cells() -> None:
    async with on_wire(LabApp(settings()), "truecolor") as pilot:
        await _answered(pilot, ANSWERS[Protocol.SIXEL])
        wire_of(pilot).sent.clear()
        await pilot.resize_terminal(110, 36)
        await until(pilot, lambda: CELL_SIZE_QUERY + ATTRIBUTES_QUERY in wire_of(pilot).sent)


async def test_kitty_is_asked_for_what_is_used_and_is_told_to_report_errors() -> None:
    async with on_wire(LabApp(settings()), "truecolor") as pilot:
        await _answered(pilot, ANSWERS[Protocol.KITTY].partition("\x1b_G")[0])
        assert KITTY_QUESTIONS in wire_of(pilot).sent
        assert pilot.app.query_one(WorldView)._tiles is None
        await _answered(pilot, ANSWERS[Protocol.KITTY])
        codes = "".join(wire_of(pilot).sent)
        commands = re.findall(r"\x1b_G([^;\x1b]*)", codes)
        assert all("U=1" in one.split(",") for one in commands if "a=q" in one.split(","))
        assert all("q=1" in one.split(",") for one in commands if "a=T" in one.split(","))


async def test_an_error_of_kitty_brings_the_cells_back_at_once() -> None:
    async with on_wire(LabApp(settings()), "truecolor") as pilot:
        await _answered(pilot, ANSWERS[Protocol.KITTY])
        await _sharp(pilot, pilot.app.query_one(WorldView))
        await _answered(pilot, ANSWERS[Protocol.KITTY] + "\x1b_Gi=1;ENOSPC:No space left\x1b\\")
        assert pilot.app.query_one(WorldView)._tiles is None
        seen = _seen(pilot)
        assert not seen.pixels.any(), "a picture is still in sight"
        assert any("ENOSPC:No space left" in notice.message for notice in lab(pilot)._notifications)


async def test_one_key_switches_to_characters_and_back() -> None:
    async with on_wire(LabApp(settings()), "truecolor") as pilot:
        await _answered(pilot, ANSWERS[Protocol.SIXEL])
        assert any(action.id == "pixels" for action in lab(pilot).key_footer._actions)
        await pilot.press("number_sign")
        assert pilot.app.query_one(WorldView)._tiles is None
        await pilot.press("number_sign")
        assert pilot.app.query_one(WorldView)._tiles is not None


async def test_a_terminal_without_pixels_gets_cells() -> None:
    async with on_wire(LabApp(settings()), "truecolor") as pilot:
        await _answered(pilot, "\x1b[?1;2c")
        assert pilot.app.query_one(WorldView)._tiles is None


async def test_who_wants_no_colors_gets_no_pixels(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NO_COLOR", "1")
    async with on_wire(LabApp(settings()), "truecolor") as pilot:
        await _answered(pilot, ANSWERS[Protocol.SIXEL])
        assert pilot.app.query_one(WorldView)._tiles is None


async def test_glyphs_that_the_user_has_chosen_are_shown_instead() -> None:
    async with on_wire(LabApp(settings()), "truecolor") as pilot:
        await _answered(pilot, ANSWERS[Protocol.SIXEL])
        lab(pilot).choose_cells(CellSet.HALF)
        await until_quiet(pilot)
        assert pilot.app.query_one(WorldView)._tiles is None
        lab(pilot).choose_cells(AUTO)
        await _sharp(pilot, pilot.app.query_one(WorldView))


@pytest.mark.slow
@pytest.mark.parametrize("protocol", Protocol)
async def test_on_a_slow_link_half_blocks_are_sent_for_what_moves(
    protocol: Protocol, monkeypatch: pytest.MonkeyPatch
) -> None:
    async with on_wire(LabApp(settings()), "truecolor") as pilot:
        await _answered(pilot, ANSWERS[protocol])
        world = pilot.app.query_one(WorldView)
        await _sharp(pilot, world)
        await pilot.press("right")
        await until_quiet(pilot)
        wire_of(pilot).sent.clear()
        lab(pilot).picture_mode.is_slow = lambda: True
        with monkeypatch.context() as patch:
            patch.setattr(Sharpness, "is_still", False)
            await pilot.press("right")
            assert world._tiles is not None and world._tiles.is_coarse
            codes = "".join(wire_of(pilot).sent)
            assert "▀" in codes and len(codes) < 4_000
            wire_of(pilot).sent.clear()
        await _sharp(pilot, world)
        assert len("".join(wire_of(pilot).sent)) < 20_000


@pytest.mark.parametrize("protocol", Protocol)
async def test_half_blocks_become_pixels_once_the_picture_stands_still(protocol: Protocol) -> None:
    async with on_wire(LabApp(settings()), "truecolor") as pilot:
        lab(pilot).picture_mode.is_slow = lambda: True
        await _answered(pilot, ANSWERS[protocol])
        for key in ("right", "a"):
            await pilot.press(key)
        world = pilot.app.query_one(WorldView)
        await _sharp(pilot, world)
        assert np.array_equal(_part(_seen(pilot), world), _drawn(world, protocol))


@pytest.mark.slow
async def test_kitty_keeps_no_images_of_pictures_that_have_gone() -> None:
    async with on_wire(LabApp(settings()), "truecolor") as pilot:
        await _answered(pilot, ANSWERS[Protocol.KITTY])
        await _sharp(pilot, pilot.app.query_one(WorldView))
        assert _seen(pilot).images
        lab(pilot).choose_cells(CellSet.HALF)
        await until_quiet(pilot)
        gc.collect()
        await pilot.press("question_mark")
        await until_quiet(pilot)
        assert not _seen(pilot).images


@pytest.mark.slow
async def test_pictures_that_have_gone_take_no_memory() -> None:
    async with on_wire(LabApp(settings()), "truecolor") as pilot:
        await _answered(pilot, ANSWERS[Protocol.SIXEL])
        gone = ref(pilot.app.query_one(WorldView)._tiles)
        lab(pilot).choose_cells(CellSet.HALF)
        await until_quiet(pilot)
        gc.collect()
        assert gone() is None
