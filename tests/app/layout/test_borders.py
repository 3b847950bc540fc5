"""Borders between panels: moved with the mouse and with the arrow keys, and kept for the next start."""

from __future__ import annotations

from typing import Any

import pytest
from textual.pilot import Pilot

from tests.app.app_help import LOGS, lab, ready, screen_text, settings, until
from tuisim.app.app import LabApp
from tuisim.app.layout.tree import Axis, Border
from tuisim.app.panels import PANELS


def border(app: LabApp, name: str) -> Border:
    return next(one for one in app.panel_area.arrangement.borders if one.name == name)


def widths(app: LabApp) -> dict[str, tuple[int, int]]:
    return {panel: (box.width, box.height) for panel, box in app.panel_area.arrangement.boxes.items()}


async def drag(pilot: Pilot[Any], name: str, by: int) -> None:
    """Drag a border by some cells, as the mouse does: from a cell of its edge."""
    app = lab(pilot)
    moved = border(app, name)
    x, y = moved.box.x + 2, moved.box.y + 2
    start = (moved.at, y) if moved.axis == Axis.COLUMNS else (x, moved.at)
    end = (start[0] + by, start[1]) if moved.axis == Axis.COLUMNS else (start[0], start[1] + by)
    await pilot.mouse_down(offset=start)
    await pilot.hover(offset=end)
    await pilot.mouse_up(offset=end)
    await pilot.pause()


@pytest.mark.quick_cases("80x24-*")
@pytest.mark.parametrize(
    ("size", "name", "by"),
    [
        ((80, 24), "world|instrumentation", -6),
        ((80, 24), "world/output", -3),
        ((120, 40), "world|instrumentation", 9),
        ((120, 40), "output|code", 8),
        ((120, 40), "arrays/controls", -2),
        ((200, 60), "code|chart", -11),
        ((60, 80), "world/instrumentation", 5),
    ],
    ids=lambda value: str(value) if isinstance(value, str | int) else f"{value[0]}x{value[1]}",
)
async def test_the_mouse_drags_a_border(size: tuple[int, int], name: str, by: int) -> None:
    async with LabApp(settings(LOGS)).run_test(size=size) as pilot:
        app = await ready(pilot)
        before = border(app, name).at
        await drag(pilot, name, by)
        assert border(app, name).at == before + by
        assert app.mouse_captured is None


@pytest.mark.quick_cases("far-left")
@pytest.mark.parametrize("by", [-300, 300], ids=["far-left", "far-right"])
async def test_a_border_stops_where_a_panel_would_get_too_small(by: int) -> None:
    async with LabApp(settings(LOGS)).run_test(size=(120, 40)) as pilot:
        app = await ready(pilot)
        moved = border(app, "world|instrumentation")
        app.panel_area._move(moved, moved.at + by)
        for panel, (width, height) in widths(app).items():
            assert width >= 24 and height >= PANELS[panel].min_rows, panel


async def test_a_border_under_the_mouse_is_marked_until_the_mouse_leaves_it() -> None:
    async with LabApp(settings(LOGS)).run_test(size=(80, 24)) as pilot:
        app = await ready(pilot)

        def marked() -> set[str]:
            return {name for name, panel in app.panel_area.panels.items() if panel.has_class("-border")}

        at = border(app, "world|instrumentation").at
        await pilot.hover(offset=(at, 5))
        await until(pilot, lambda: marked() >= {"world", "instrumentation"})
        await pilot.hover(offset=(at - 20, 5))
        await until(pilot, lambda: not marked())


@pytest.mark.quick_cases("enter-keeps", "right")
@pytest.mark.parametrize(
    ("keys", "moved"),
    [
        (("right",), 2),
        (("left", "left"), -4),
        (("right", "enter"), 2),
        (("right", "escape"), 0),
        (("right", "0", "enter"), 0),
        (("tab", "tab", "right", "enter"), 2),
    ],
    ids=["right", "left-twice", "enter-keeps", "escape-undoes", "0-resets", "of-another-panel"],
)
async def test_arrows_move_borders_in_the_layout_mode(keys: tuple[str, ...], moved: int) -> None:
    async with LabApp(settings(LOGS)).run_test(size=(80, 24)) as pilot:
        app = await ready(pilot)
        before, pose = border(app, "world|instrumentation").at, app.run_controller.snapshot().instant.pose
        await pilot.press("f4", *keys)
        assert border(app, "world|instrumentation").at == before + moved
        # The robot stays where it is.
        assert app.run_controller.snapshot().instant.pose == pose


async def test_the_layout_mode_shows_its_keys_and_gives_the_focus_back() -> None:
    async with LabApp(settings(LOGS)).run_test(size=(80, 24)) as pilot:
        app = await ready(pilot)
        await until(pilot, lambda: app.focused is app.panel_area.world)
        await pilot.press("f4")
        await until(pilot, lambda: "← ↑ ↓ → move" in screen_text(app))
        await pilot.press("enter")
        await until(pilot, lambda: "R run" in screen_text(app))
        assert app.focused is app.panel_area.world
        before = app.run_controller.snapshot().instant.pose
        await pilot.press("right")
        assert app.run_controller.snapshot().instant.pose != before


@pytest.mark.slow
async def test_the_next_start_finds_the_arrangement_for_its_size() -> None:
    async with LabApp(settings(LOGS)).run_test(size=(120, 40)) as pilot:
        app = await ready(pilot)
        await pilot.press("f7", "f4", "right", "right", "enter", "i")
        kept = widths(app)
    async with LabApp(settings(LOGS)).run_test(size=(120, 40)) as pilot:
        assert widths(await ready(pilot)) == kept
    async with LabApp(settings(LOGS)).run_test(size=(80, 24)) as pilot:
        app = await ready(pilot)
        assert app.panel_area.preset == "standard"
        assert app.panel_area.moved == {}
