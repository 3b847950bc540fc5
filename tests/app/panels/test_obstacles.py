"""Obstacles: listed, typed, drawn with the mouse, chosen and saved; and what a blocked robot shows."""

from __future__ import annotations

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

import pytest
from textual.pilot import Pilot
from textual.widgets import Input, OptionList, Static

from tests.app.app_help import (
    LOGS,
    open_lab,
    screen_text,
    until,
    until_shown,
)
from tuisim.app.app import LabApp
from tuisim.app.panels.obstacles import BoxGrip, Obstacles, add_box, find_box
from tuisim.app.panels.world import WorldView
from tuisim.app.setup.next_run import change_obstacles
from tuisim.engine.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM, Obstacle
from tuisim.engine.obstacles import OBSTACLES, load_obstacles


def boxes(app: LabApp) -> tuple[Obstacle, ...]:
    return app.run_controller.next_run.spec.world.obstacles


@asynccontextmanager
async def open_obstacles(
    size: tuple[int, int] = (120, 40),
) -> AsyncIterator[tuple[Pilot[Any], LabApp]]:
    """Open the app with the list of obstacles at hand."""
    async with open_lab(LOGS, size=size) as (pilot, app):
        await pilot.press("B")
        await until(pilot, lambda: app.focused is app.query_one("Obstacles OptionList"))
        yield pilot, app


def cell(app: LabApp, x_mm: float, y_mm: float) -> tuple[int, int]:
    """Where a point of the world is in the picture."""
    port = app.query_one(WorldView)._port
    assert port is not None
    col, row = port.to_px(x_mm, y_mm)
    return int(col), int(row / 2)


async def drag(pilot: Pilot[Any], start: tuple[int, int], end: tuple[int, int]) -> None:
    await pilot.mouse_down(WorldView, offset=start)
    await pilot.hover(WorldView, offset=end)
    await pilot.mouse_up(WorldView, offset=end)
    await pilot.pause()


@pytest.mark.quick_cases("80x24")
@pytest.mark.parametrize("size", [(80, 24), (120, 40)], ids=["80x24", "120x40"])
async def test_an_empty_list_of_obstacles_says_how_to_add_one(size: tuple[int, int]) -> None:
    async with open_obstacles(size=size) as (_, app):
        assert "none: + or drag adds one" in screen_text(app)
        assert "drag to draw or move an obstacle" in screen_text(app)
        assert all(entry.disabled for entry in app.query("Obstacles Input"))


@pytest.mark.slow
async def test_obstacles_are_added_edited_and_removed_by_keys() -> None:
    async with open_obstacles(size=(80, 24)) as (pilot, app):
        await pilot.press("plus", "plus")
        await until(pilot, lambda: len(boxes(app)) == 2)
        await pilot.pause()
        assert boxes(app)[0] != boxes(app)[1]
        await pilot.press("enter")
        app.query_one("#x_mm", Input).value = "30"
        await pilot.press("enter")
        await until(pilot, lambda: boxes(app)[1].x_mm == 30)
        await until_shown(pilot, "200×200 at 30, ")
        app.query_one("Obstacles OptionList").focus()
        await pilot.press("delete")
        await until(pilot, lambda: len(boxes(app)) == 1)
        await pilot.press("delete")
        await until(pilot, lambda: boxes(app) == ())
        await pilot.pause()
        await pilot.press("delete")
        assert "No obstacle to remove" in screen_text(app)


@pytest.mark.slow
async def test_a_wrong_number_for_an_obstacle_is_refused() -> None:
    async with open_obstacles() as (pilot, app):
        await pilot.press("plus")
        await until(pilot, lambda: len(boxes(app)) == 1)
        await pilot.pause()
        before = boxes(app)
        for field, typed, said in (
            ("width_mm", "0", "W must be above 0, got 0.0"),
            ("x_mm", "wide", "X must be a number, got 'wide'"),
            ("y_mm", "1e9", "Y must be a number from -10000 to 10000, got 1000000000.0"),
            ("height_mm", "nan", "H must be a number from -10000 to 10000, got nan"),
        ):
            entry = app.query_one(f"#{field}", Input)
            entry.focus()
            right = entry.value
            entry.value = typed
            await pilot.press("enter")
            await refused(pilot, said)
            assert boxes(app) == before
            entry.value = right
            await pilot.press("enter")


async def refused(pilot: Pilot[Any], said: str) -> None:
    """Wait until the panel says why."""
    message = pilot.app.query_one("Obstacles #message", Static)
    await until(pilot, lambda: str(message.render()) == said)


@pytest.mark.slow
async def test_an_obstacle_is_drawn_and_moved_with_the_mouse() -> None:
    async with open_obstacles() as (pilot, app):
        start, end = cell(app, 1000, 900), cell(app, 1300, 600)
        await drag(pilot, start, end)
        await until(pilot, lambda: len(boxes(app)) == 1)
        made = boxes(app)[0]
        assert (made.x_mm, made.y_mm + made.height_mm) == pytest.approx((1000, 900), abs=35)
        assert (made.width_mm, made.height_mm) == pytest.approx((300, 300), abs=70)
        await drag(pilot, cell(app, 1150, 750), cell(app, 1550, 750))
        await until(pilot, lambda: boxes(app)[0].x_mm > 1300)
        assert boxes(app)[0].x_mm == pytest.approx(made.x_mm + 400, abs=35)
        assert (boxes(app)[0].width_mm, boxes(app)[0].y_mm) == (made.width_mm, made.y_mm)
        assert app.run_controller.pose.x_mm == 150


@pytest.mark.slow
async def test_a_click_chooses_and_the_mouse_draws_only_while_the_panel_is_shown() -> None:
    async with open_obstacles() as (pilot, app):
        app.loader.set_next_run(
            change_obstacles(app.run_controller.next_run, OBSTACLES["Square_posts"])
        )
        await pilot.pause()
        await pilot.click(WorldView, offset=cell(app, 550, 250))
        await until(pilot, lambda: app.query_one(Obstacles).at == 0)
        await pilot.press("B", "B")
        await drag(pilot, cell(app, 1000, 900), cell(app, 1300, 600))
        assert boxes(app) == OBSTACLES["Square_posts"]
        assert "drag to draw" not in screen_text(app)


@pytest.mark.slow
async def test_the_selected_obstacle_is_marked_in_the_world() -> None:
    async with open_obstacles() as (pilot, app):
        app.loader.set_next_run(change_obstacles(app.run_controller.next_run, OBSTACLES["Wall"]))
        view = app.query_one(WorldView)
        await until(pilot, lambda: view._scene is not None and view._scene.marked == 0)
        before = view._cells.copy()
        await pilot.press("B")
        await until(pilot, lambda: view._scene is not None and view._scene.marked is None)
        assert view._cells.shape != before.shape or (view._cells != before).any()


@pytest.mark.slow
async def test_a_set_of_obstacles_can_be_chosen_and_saved_to_a_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    async with open_lab(LOGS) as (pilot, app):
        await pilot.press("k")
        sets = app.screen.query_one(OptionList)
        sets.highlighted = sets.get_option_index("Wall")
        await pilot.press("enter")
        await until(pilot, lambda: boxes(app) == OBSTACLES["Wall"])
        await pilot.press("ctrl+o")
        app.screen.query_one(Input).value = "mine.toml"
        await pilot.press("enter")
        await until(pilot, lambda: len(app.screen_stack) == 1)
        assert load_obstacles("mine.toml") == OBSTACLES["Wall"]
        await pilot.press("k")
        sets = app.screen.query_one(OptionList)
        assert str(tmp_path / "mine.toml") in [option.id for option in sets.options]


BOXES = (Obstacle(100, 100, 200, 200), Obstacle(200, 200, 200, 200), Obstacle(900, 100, 2, 300))


@pytest.mark.parametrize(
    "point, index",
    [((150, 150), 0), ((250, 250), 1), ((350, 350), 1), ((910, 200), 2), ((600, 600), None)],
    ids=["one", "the upper of two", "beside the lower", "a thin one nearby", "none"],
)
def test_the_topmost_obstacle_under_the_mouse_is_found(
    point: tuple[float, float], index: int | None
) -> None:
    assert find_box(BOXES, *point, slack_mm=15) == index


@pytest.mark.parametrize(
    "start, end, drawn",
    [
        ((100, 100), (301, 402), Obstacle(100, 100, 200, 300)),
        ((300, 400), (101, 99), Obstacle(100, 100, 200, 300)),
        ((-50, 1000), (100, 2000), Obstacle(0, 1000, 100, 145)),
        ((100, 100), (110, 300), None),
    ],
    ids=["up", "down", "only on the field", "too thin"],
)
def test_a_drag_draws_a_box_unless_it_is_too_small(
    start: tuple[float, float], end: tuple[float, float], drawn: Obstacle | None
) -> None:
    made = BoxGrip((), None, *start).drag_boxes(*end)
    assert made == (None if drawn is None else ((drawn,), 0))


def test_a_box_stays_within_reach() -> None:
    moved = BoxGrip(BOXES, 0, 150, 150).drag_boxes(-5000, 9000)
    assert moved is not None
    assert moved[0][0] == Obstacle(-100, 1043, 200, 200)
    assert moved[0][1:] == BOXES[1:]


def test_new_obstacles_overlap_no_other_until_the_field_is_full() -> None:
    placed: tuple[Obstacle, ...] = ()
    for _ in range(45):
        middle = [(box.x_mm + 100, box.y_mm + 100) for box in placed]
        placed = add_box(placed)
        new = placed[-1]
        assert all(
            max(abs(new.x_mm + 100 - x_mm), abs(new.y_mm + 100 - y_mm)) >= 220
            for x_mm, y_mm in middle
        )
        assert 0 <= new.x_mm <= FIELD_WIDTH_MM - 200 and 0 <= new.y_mm <= FIELD_HEIGHT_MM - 200
    assert (placed[1].x_mm - placed[0].x_mm, placed[1].y_mm) == (220, placed[0].y_mm)
    assert len(add_box(placed)) == 46
