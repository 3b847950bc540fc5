"""The chart panel."""

from __future__ import annotations

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import replace
from typing import Any

import pytest
from textual.pilot import Pilot

from tests.app.app_help import until
from tests.app.panel_help import SPEC, PanelApp, moment, screen_text
from tests.cases import cases
from tuisim.app.panels.chart import Chart
from tuisim.app.snapshot import RunPhase
from tuisim.pictures.charts.text_chart import ChartPainter, ChartPicture


def fill(chart: Chart) -> None:
    for at in range(50):
        chart.append("Colour", [at / 10], [100.0 if at < 25 else 20.0])
        chart.append("gyro_deg", [at / 10], [float(at)], logged=False)


@asynccontextmanager
async def open_chart(
    size: tuple[int, int] = (80, 16),
) -> AsyncIterator[tuple[Pilot[None], PanelApp[Chart]]]:
    """Show a chart of two traces."""
    app = PanelApp(Chart())
    async with app.run_test(size=size) as pilot:
        fill(app.panel)
        yield pilot, app


def rows(app: PanelApp[Chart]) -> list[str]:
    app.panel._redraw()
    return screen_text(app)


async def opened(app: PanelApp[Chart], pilot: Pilot[None]) -> None:
    app.panel.focus()
    await pilot.pause()


@pytest.mark.parametrize("hz", [100, 30])
async def test_the_readout_of_a_past_tick_is_what_was_printed_last_in_it(hz: int) -> None:
    async with open_chart() as (_, app):
        spec = replace(SPEC, profile=replace(SPEC.profile, tick_hz=hz))
        times_s = (80.99 / hz, 81 / hz, 81.99 / hz, 82 / hz, 82.5 / hz)
        app.panel.show_printed(times_s[2])
        app.panel.append("pos", times_s, (-1.0, -2.0, -3.0, -4.0, -5.0))
        now = moment(spec=spec)
        app.panel.show(replace(now, past=True, instant=replace(now.instant, tick=81)))
        rows(app)
        assert "pos -3" in str(app.panel.border_subtitle)
        copied = app.panel.copy_text()
        assert copied is not None and "pos -3" in copied.text


@pytest.mark.parametrize("size", [(20, 6), (80, 16), (180, 30)], ids=str)
async def test_the_chart_draws_logged_samples(size: tuple[int, int]) -> None:
    async with open_chart(size=size) as (pilot, app):
        app.panel.show(moment())
        await pilot.pause()

        text = "".join(rows(app))

    assert "[x] Colour" in text
    assert any("⠀" < char <= "⣿" for char in text)


async def test_a_chart_shows_samples_that_came_before_it_was_opened() -> None:
    chart = Chart()
    fill(chart)
    app = PanelApp(chart)
    async with app.run_test(size=(80, 16)) as pilot:
        await pilot.pause()

        assert "[x] Colour" in rows(app)[0]


async def test_keys_tick_and_untick_traces_of_the_chart() -> None:
    async with open_chart() as (pilot, app):
        await opened(app, pilot)
        seen = []
        for key in ("down", "enter", "1", "up", "enter", "2"):
            await pilot.press(key)
            seen.append(rows(app)[0].strip())

    assert seen == [
        "[x] Colour  [ ] gyro_deg",
        "[x] Colour  [x] gyro_deg",
        "[ ] Colour  [x] gyro_deg",
        "[ ] Colour  [x] gyro_deg",
        "[ ] Colour  [ ] gyro_deg",
        "[ ] Colour  [x] gyro_deg",
    ]


async def test_space_goes_on_with_a_paused_run_and_escape_leaves_the_chart() -> None:
    async with open_chart() as (pilot, app):
        await opened(app, pilot)
        await pilot.press("space")
        assert rows(app)[0].strip() == "[x] Colour  [ ] gyro_deg"
        await pilot.press("left", "escape")
        assert app.panel.has_focus
        await pilot.press("escape")
        assert not app.panel.has_focus


async def test_a_chart_without_ticked_traces_names_the_keys_that_tick_them() -> None:
    async with open_chart() as (pilot, app):
        await opened(app, pilot)
        await pilot.press("enter")
        assert "↑ ↓ and enter show a trace" in "".join(rows(app))


async def test_the_mouse_ticks_traces() -> None:
    async with open_chart() as (pilot, app):
        rows(app)
        await pilot.click(app.panel, offset=(1, 0))

        assert rows(app)[0].startswith("[ ] Colour")


async def test_arrow_keys_move_the_charts_cursor_and_escape_removes_it() -> None:
    async with open_chart() as (pilot, app):
        await opened(app, pilot)
        await pilot.press("left", "left", "shift+left")
        rows(app)
        last = str(app.panel.border_subtitle)
        await pilot.press("escape")
        await pilot.pause()

    moves = app.heard(Chart.CursorMoved)
    times = [message.time_s for message in moves if message.time_s is not None]
    # The first step goes one column back from the newest point, which is at 4.9 s.
    assert 4.7 < times[0] < 4.9
    assert times[0] > times[1] > times[2]
    assert moves[-1].time_s is None
    assert last.split()[:3] == [f"{times[2]:.2f}", "s", "Colour"]


async def test_clicking_and_dragging_in_the_chart_moves_its_cursor() -> None:
    async with open_chart() as (pilot, app):
        rows(app)
        await pilot.mouse_down(app.panel, offset=(40, 5))
        await pilot.hover(app.panel, offset=(50, 5))
        await pilot.mouse_up(app.panel, offset=(50, 5))
        await pilot.pause()

    first, second = (message.time_s for message in app.heard(Chart.CursorMoved))
    assert first is not None and second is not None
    assert 2 < first < second < 3.5


async def test_the_mouse_reads_values_without_a_press() -> None:
    async with open_chart() as (pilot, app):
        rows(app)
        await pilot.hover(app.panel, offset=(60, 5))
        read = str(app.panel.border_subtitle).split()
        await pilot.hover(app.panel, offset=(60, 0))
        await pilot.pause()

    assert read[1:] == ["s", "Colour", "20"]
    assert 2.5 < float(read[0]) < 4.9
    assert not app.panel.border_subtitle
    assert not app.heard(Chart.CursorMoved)


async def test_a_frozen_chart_keeps_its_time_window_when_samples_arrive() -> None:
    async with open_chart() as (pilot, app):
        await opened(app, pilot)
        rows(app)
        await pilot.press("f")
        app.panel.append("Colour", [100.0], [50.0])
        frozen = (rows(app)[-1], app.panel.border_subtitle)
        await pilot.press("f")
        following = (rows(app)[-1], app.panel.border_subtitle)

    assert frozen[0].rstrip().endswith("4 s")
    assert frozen[1] == Chart.FROZEN
    assert following[0].rstrip().endswith("100 s")
    assert not following[1]


async def test_the_charts_border_says_how_far_it_is_drawn_until_it_is_drawn_to_the_end() -> None:
    async with open_chart() as (_, app):
        app.panel.show_lag("drawn to 1.2 of 7.0 s")
        assert app.panel.border_subtitle == "drawn to 1.2 of 7.0 s"
        app.panel.show_lag("")
        assert not app.panel.border_subtitle


async def test_clearing_the_chart_keeps_which_traces_are_ticked() -> None:
    async with open_chart() as (pilot, app):
        await opened(app, pilot)
        await pilot.press("2", "delete")
        empty = rows(app)
        app.panel.append("gyro_deg", [0.0, 1.0], [1.0, 2.0], logged=False)
        gyro = rows(app)[0]
        app.panel.append("Colour", [0.0, 1.0], [1.0, 2.0])

        assert any("print('Colour: ' + str(value))" in row for row in empty)
        assert gyro.startswith("[x] gyro_deg")
        assert rows(app)[0].startswith("[x] Colour  [x] gyro_deg")


async def test_the_chart_is_not_drawn_more_often_than_can_be_seen(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    app = PanelApp(Chart())
    async with app.run_test(size=(80, 16)) as pilot:
        await until(pilot, lambda: app.panel._picture is not None)
        drawn: list[object] = []
        paint = ChartPainter.paint

        def painted(*args: Any, **more: Any) -> ChartPicture:
            drawn.append(args)
            # At the end the panel may lose the focus, and is then drawn at once.
            return paint(*args, **more)

        monkeypatch.setattr(ChartPainter, "paint", painted)
        app.panel._throttle._last_s = float("inf")

        for at in range(100):
            app.panel.append("Colour", [at / 10], [1.0])
            app.panel.show(moment())

        assert not drawn


async def test_the_chart_names_bands_only_while_the_run_is_paused_or_ended() -> None:
    async with open_chart() as (pilot, app):
        shown = []
        for state in (RunPhase.RUNNING, RunPhase.PAUSED, RunPhase.RUNNING, RunPhase.ENDED):
            app.panel.show(moment(state=state))
            await pilot.pause()
            shown.append(any("100 white" in row for row in rows(app)))

    assert shown == [False, True, False, True]


@cases(
    "column, sample",
    {"in a band": (30, "Colour"), "beside all samples": (70, "")},
)
async def test_a_click_goes_to_the_sample_there(column: int, sample: str) -> None:
    app = PanelApp(Chart())
    async with app.run_test(size=(80, 16)) as pilot:
        for at in range(0, 50, 5):
            app.panel.append("Colour", [at / 10], [100.0])
        app.panel.append("gyro_deg", [6.0], [1.0], logged=False)
        app.panel.show(moment(state=RunPhase.ENDED))
        rows(app)
        await pilot.mouse_down(app.panel, offset=(column, 5))
        await pilot.pause()

    (message,) = app.heard(Chart.CursorMoved)
    assert message.sample == sample
    assert (message.time_s in [at / 10 for at in range(0, 50, 5)]) is bool(sample)
