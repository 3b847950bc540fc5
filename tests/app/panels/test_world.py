"""The world panel."""

from __future__ import annotations

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import replace

import numpy as np
import pytest
from textual import events
from textual.content import Content
from textual.geometry import Region
from textual.pilot import Pilot

from tests.app.app_help import LOGS, open_lab, until, until_state
from tests.app.panel_help import PanelApp, moment, white_mat
from tests.cases import for_rows
from tuisim.app.layout.tree import TIME_BAR_ROWS
from tuisim.app.panels.world import TURN_STEP_DEG, World, WorldView
from tuisim.app.render.world_text import build_legend
from tuisim.app.snapshot import RunPhase, Snapshot
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.spec import FIELD_WIDTH_MM
from tuisim.pictures.scene.pictures import build_scene
from tuisim.pictures.scene.view import Viewport
from tuisim.terminal.cells import find_cell_points
from tuisim.terminal.picture_options import CellSet

POSE = Pose(1000.0, 500.0, 0.0)


@asynccontextmanager
async def open_world(
    now: Snapshot | None = None, size: tuple[int, int] = (76, 27)
) -> AsyncIterator[tuple[Pilot[None], PanelApp[World]]]:
    """Show the world on a white mat, at an instant or the usual one."""
    app = PanelApp(World())
    async with app.run_test(size=size) as pilot:
        app.panel.set_mat(white_mat())
        app.panel.show(now or moment())
        await pilot.pause()
        yield pilot, app


def cell_of(world: World, x_mm: float, y_mm: float) -> tuple[int, int]:
    port = view(world)._port
    assert port is not None
    col, row = port.to_px(x_mm, y_mm)
    return int(col), int(row / 2)


def view(world: World) -> WorldView:
    return world.query_one(WorldView)


def colours(world: World) -> int:
    return len(np.unique(view(world)._cells))


@pytest.mark.parametrize("size", [(20, 6), (76, 27), (190, 50)], ids=str)
async def test_the_world_shows_mat_and_robot(size: tuple[int, int]) -> None:
    async with open_world(size=size) as (_, app):
        assert view(app.panel)._cells.shape == (size[1] - TIME_BAR_ROWS, size[0])
        assert colours(app.panel) > 5


async def test_the_world_keeps_its_size_when_a_run_starts() -> None:
    async with open_world(moment(state=RunPhase.IDLE), size=(40, 12)) as (pilot, app):
        before = view(app.panel).size
        app.panel.time_bar.show(moment(now_tick=321))
        await pilot.pause()
        assert (view(app.panel).size, len(app.panel.time_bar._lines)) == (before, 1)


_ASTRAY = Pose(-4000.0, 500.0, 0.0)


@for_rows(
    "now_pose, earlier_pose, width, words",
    [
        (None, None, 70, ""),
        (POSE, None, 70, "outline: the robot now"),
        (POSE, None, 21, "outline: now"),
        (None, POSE, 70, "grey: the earlier run"),
        (POSE, POSE, 70, "outline: the robot now, grey: the earlier run"),
        (POSE, POSE, 30, "outline: now, grey: earlier"),
        (POSE, POSE, 21, "line now, grey before"),
        (_ASTRAY, POSE, 70, "grey: the earlier run"),
    ],
)
def test_the_frame_says_what_the_other_robots_are(
    now_pose: Pose | None, earlier_pose: Pose | None, width: int, words: str
) -> None:
    assert build_legend(moment(now_pose=now_pose, earlier_pose=earlier_pose), width) == words


@pytest.mark.parametrize("mm_per_px, words", [(30.0, "robot drawn 2.1× its size"), (10.0, "")])
def test_the_frame_says_that_the_robot_is_larger_than_the_mat_beside_it(
    mm_per_px: float, words: str
) -> None:
    view = Viewport(80, 40, mm_per_px, 0.0, 1000.0, find_cell_points(CellSet.BRAILLE))
    assert build_legend(moment(), 70, view) == words


async def test_the_world_is_blank_until_the_mat_is_there() -> None:
    app = PanelApp(World())
    async with app.run_test(size=(40, 12)) as pilot:
        app.panel.show(moment())
        await pilot.pause()
        assert view(app.panel)._cells.size == 0

        app.panel.set_mat(white_mat())
        assert view(app.panel)._cells.size


async def test_the_world_is_not_painted_again_while_nothing_in_it_has_changed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    async with open_world(size=(40, 12)) as (_, app):
        painted: list[object] = []
        monkeypatch.setattr(
            view(app.panel), "set_fine_picture", lambda picture, _, **__: painted.append(picture)
        )

        app.panel.show(moment(time_s=9.0))
        assert not painted
        app.panel.show(moment(Pose(1010.0, 500.0, 0.0)))
        assert len(painted) == 1


async def test_moving_the_robot_repaints_only_the_cells_around_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    async with open_world() as (_, app):
        regions: list[Region] = []
        monkeypatch.setattr(
            view(app.panel), "refresh", lambda *changed, **_: regions.extend(changed)
        )

        app.panel.show(moment(Pose(1040.0, 500.0, 0.0)))

    assert 0 < sum(region.area for region in regions) < 50


async def test_rays_are_drawn_when_switched_on() -> None:
    async with open_world() as (_, app):
        before = view(app.panel)._cells.copy()

        app.panel.show_rays = True

        assert (before != view(app.panel)._cells).sum() > 20


async def test_the_trace_survives_another_mat_and_can_be_cleared() -> None:
    app = PanelApp(World())
    async with app.run_test(size=(76, 27)):
        app.panel.extend_trace([200.0, 400.0], [300.0, 300.0])
        app.panel.set_mat(white_mat())
        app.panel.show(moment())
        col, row = cell_of(app.panel, 300, 300)
        plain = view(app.panel)._cells[row, 2]
        assert view(app.panel)._cells[row, col] != plain

        app.panel.set_mat(white_mat())
        assert view(app.panel)._cells[row, col] != plain
        app.panel.clear_trace()
        assert view(app.panel)._cells[row, col] == plain


async def test_while_looking_at_the_past_a_ghost_shows_where_the_robot_is_now() -> None:
    async with open_world() as (_, app):
        before = view(app.panel)._cells.copy()

        app.panel.show(moment(now_pose=Pose(300.0, 300.0, 90.0)))
        assert (before != view(app.panel)._cells).any()
        app.panel.show(moment())
        assert (before == view(app.panel)._cells).all()


async def test_zoom_of_the_world_cycles_through_its_steps_and_the_title_names_it() -> None:
    async with open_world() as (_, app):
        seen = []
        for _ in range(3):
            app.panel.cycle_zoom()
            title = Content.from_markup(app.panel.border_title or "").plain
            seen.append((app.panel.zoom, title))

    title = f"W World: {moment().spec.world.background}"
    assert seen == [(2, f"{title} 2×"), (4, f"{title} 4×"), (1, title)]


async def dragged(shift: bool, by: tuple[int, int]) -> list[World.PoseDragged]:
    """Drag the robot by some cells from a point ahead of its middle."""
    async with open_world(moment(POSE), size=(120, 30)) as (pilot, app):
        col, row = cell_of(app.panel, POSE.x_mm + 40, POSE.y_mm)
        start, end = (col, row), (col + by[0], row + by[1])
        await pilot.mouse_down(view(app.panel), offset=start, shift=shift)
        await pilot.hover(view(app.panel), offset=end)
        await pilot.mouse_up(view(app.panel), offset=end, shift=shift)
        await pilot.pause()
        return app.heard(World.PoseDragged)


async def test_dragging_moves_the_robot() -> None:
    messages = await dragged(False, (10, -3))

    assert [message.done for message in messages] == [False, True]
    pose = messages[-1].pose
    px_mm = FIELD_WIDTH_MM / 120
    assert pose.x_mm == pytest.approx(POSE.x_mm + 10 * px_mm, abs=1)
    assert pose.y_mm == pytest.approx(POSE.y_mm + 6 * px_mm, abs=1)
    assert pose.heading_deg == POSE.heading_deg


async def test_dragging_with_shift_turns_the_robot() -> None:
    messages = await dragged(True, (-2, -5))

    pose = messages[-1].pose
    assert (pose.x_mm, pose.y_mm) == (POSE.x_mm, POSE.y_mm)
    assert 45 < pose.heading_deg < 135


async def test_dragging_beside_the_robot_does_not_move_it() -> None:
    async with open_world(moment(POSE), size=(120, 30)) as (pilot, app):
        await pilot.mouse_down(view(app.panel), offset=(2, 2))
        await pilot.hover(view(app.panel), offset=(20, 5))
        await pilot.mouse_up(view(app.panel), offset=(20, 5))

    assert not app.messages


async def test_ctrl_and_the_wheel_zoom_the_world_as_two_fingers_do() -> None:
    async with open_world(moment(POSE), size=(120, 30)) as (pilot, app):
        target = view(app.panel)
        seen = []
        for kind in [events.MouseScrollUp] * 3 + [events.MouseScrollDown] * 3:
            target.post_message(kind(target, 2, 2, 0, 0, 0, False, False, True))
            await pilot.pause()
            seen.append(app.panel.zoom)

    assert seen == [2, 4, 4, 2, 1, 1]
    assert app.heard(World.PoseDragged) == []


@pytest.mark.parametrize(
    "kind, turn",
    [(events.MouseScrollUp, TURN_STEP_DEG), (events.MouseScrollDown, -TURN_STEP_DEG)],
)
async def test_the_wheel_turns_the_robot_that_it_is_over(
    kind: type[events.MouseEvent], turn: float
) -> None:
    async with open_world(moment(POSE), size=(120, 30)) as (pilot, app):
        target = view(app.panel)
        robot = cell_of(app.panel, POSE.x_mm, POSE.y_mm)
        for col, row in (robot, robot, (2, 2)):
            target.post_message(kind(target, col, row, 0, 0, 0, False, False, False))
        await pilot.pause()

    messages = app.heard(World.PoseDragged)
    assert [message.pose for message in messages] == [
        replace(POSE, heading_deg=turn),
        replace(POSE, heading_deg=2 * turn),
    ]
    assert all(message.done for message in messages)


@pytest.mark.slow
async def test_the_world_panel_shows_the_scene_that_a_picture_file_would_show() -> None:
    async with open_lab(LOGS, "Obstacles_Test", size=(80, 24)) as (pilot, app):
        await pilot.press("R")
        await until_state(pilot, RunPhase.ENDED)
        view = app.query_one(WorldView)
        recording = app.run_controller.timeline.recording
        assert recording is not None
        last = recording.telemetry.last()
        await until(
            pilot, lambda: view._scene is not None and view._scene.pose == (last and last.pose)
        )
        assert last is not None and view._scene is not None

        shown = replace(view._scene, rays=(), rays_from=None)

        assert shown == build_scene(recording.spec, last.pose)
