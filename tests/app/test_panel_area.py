"""Every size of terminal: nothing is cut, and the world is as large as its panel allows."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Iterator, Sequence

import pytest
from textual.content import Content
from textual.widget import Widget
from textual.widgets import Static

from tests.app.app_help import LOGS, open_lab, screen_text, until, until_typing
from tests.app.layout.test_arrangement_presets import KEYS, SIZES
from tuisim.app.app import LabApp
from tuisim.app.panels.world import WorldView
from tuisim.engine.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM
from tuisim.engine.protocol import End

USERS = frozenset({"code", "output"})
"""Panels with the user's own text, whose lines may be longer than any panel."""
CUT = re.compile(r"\S…")
"""The end of a text that was cut; `go to …` is a text of its own."""
in_each_size = pytest.mark.parametrize(
    "size", [*SIZES, (40, 12)], ids=lambda size: f"{size[0]}x{size[1]}"
)


def cut(app: LabApp) -> Iterator[str]:
    """Yield each text on the screen that is not shown in full."""
    screen = screen_text(app).split("\n")
    for name, box in app.panel_area.arrangement.boxes.items():
        panel = app.panel_area.panels[name]
        if name not in USERS:
            yield from (f"{name}: {line}" for line in lines_of(panel, screen) if CUT.search(line))
        for title in (panel.border_title, panel.border_subtitle):
            shown = Content.from_markup(str(title or "")).cell_length
            if name not in USERS and shown > box.width - 6:
                yield f"{name}: {title}"
        for text in panel.query(Static):
            if text.region and not fits(text):
                yield f"{name}: {text.render()}"


def lines_of(panel: Widget, screen: Sequence[str]) -> list[str]:
    x, y, width, height = panel.region
    return [line[x : x + width] for line in screen[y : y + height]]


def fits(text: Static) -> bool:
    size = text.content_size
    return text.get_content_height(size, size, size.width) <= size.height and (
        size.height > 1 or text.get_content_width(size, size) <= size.width
    )


@in_each_size
@pytest.mark.slow
async def test_no_text_of_a_panel_is_cut_in_any_layout(size: tuple[int, int]) -> None:
    async with open_lab(LOGS, autorun=True, speed=0.0, size=size) as (pilot, app):
        await until(pilot, lambda: app.run_controller.build_snapshot().end == End.FINISHED)
        for keys in ((), *((key,) for key in KEYS.values())):
            await pilot.press(*keys)
            await pilot.pause(0.2)
            assert list(cut(app)) == [], keys


@pytest.mark.quick_cases("80x24", "120x40", "40x12")
@in_each_size
async def test_the_world_is_as_large_as_its_panel(size: tuple[int, int]) -> None:
    async with open_lab(LOGS, size=size) as (pilot, app):
        view = app.query_one(WorldView)
        await until(pilot, lambda: view._port is not None)
        port = view._port
        assert port is not None
        cell = view.choose_cell(view.graphics)
        columns, rows = (
            FIELD_WIDTH_MM / port.mm_per_px / cell.cols,
            FIELD_HEIGHT_MM / port.mm_per_row / cell.rows,
        )
        # The whole mat, with one of its sides as long as the panel's, within a cell.
        assert columns <= view.size.width + 1 and rows <= view.size.height + 1
        assert columns >= view.size.width - 1 or rows >= view.size.height - 1
        assert columns / rows == pytest.approx(2 * FIELD_WIDTH_MM / FIELD_HEIGHT_MM, rel=0.02)
        # The panel has the shape of the mat, but for the row of the time bar; below 60 columns it is the screen.
        if size[0] >= 60:
            assert columns * rows >= 0.8 * view.size.width * (view.size.height - 1)


@pytest.mark.slow
async def test_the_panel_with_the_focus_stays_when_the_keyboard_of_a_phone_takes_room() -> None:
    async with open_lab(LOGS, size=(64, 60)) as (pilot, app):
        area = app.panel_area
        await until(pilot, lambda: area.is_shown("code"))
        area.focus_opened("code")
        await until(pilot, lambda: area.find_focused_panel() == "code")
        for rows in (56, 40, 30, 60):
            await pilot.resize_terminal(64, rows)
            await until(pilot, lambda rows=rows: area.size.height == rows - 1)  # type: ignore[misc]
            assert (area.is_shown("code"), area.find_focused_panel()) == (True, "code"), rows


@pytest.mark.slow
async def test_a_large_terminal_edits_in_a_high_panel_beside_the_world() -> None:
    async with open_lab(LOGS, size=(200, 60)) as (pilot, app):
        boxes = app.panel_area.arrangement.boxes
        assert boxes["code"].width >= 80 and boxes["world"].width >= 150
        await pilot.press("d")
        await until_typing(pilot)
        boxes = app.panel_area.arrangement.boxes
        assert boxes["code"].width >= 86 and boxes["code"].height >= 35
        assert boxes["world"].x == boxes["code"].width


@pytest.mark.slow
def test_panels_and_what_they_ask_are_imported_when_they_are_shown() -> None:
    code = "import sys, tuisim.app.app; print({'tuisim.app.panels.chart', 'jedi'} & {*sys.modules})"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.stdout == "set()\n"
