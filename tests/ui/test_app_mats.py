"""The mat picker: pictures, and images of one's own."""

from __future__ import annotations

from pathlib import Path

import pytest
from PIL import Image
from textual.pilot import Pilot
from textual.widgets import Input, OptionList, Static

from tests.ui.app_help import LOGS, notices, ready, settings, until
from tuisim.ui.app import Lab
from tuisim.ui.cellview import PixelView


@pytest.mark.parametrize("size", [(80, 24), (120, 40)], ids=["80x24", "120x40"])
async def test_the_mat_at_hand_is_shown(size: tuple[int, int]) -> None:
    async with Lab(settings(LOGS)).run_test(size=size) as pilot:
        app = await ready(pilot)
        await pilot.press("b")
        view = app.screen.query_one(PixelView)
        await until(pilot, lambda: view._cells.size > 0)
        bands = view._cells.copy()
        assert view.region.bottom < size[1]
        mats = app.screen.query_one(OptionList)
        mats.highlighted = mats.get_option_index("Rainbow_bands")
        await until(pilot, lambda: view._cells.shape == bands.shape and bool((view._cells != bands).any()))
        assert "Seven coloured bands" in str(app.screen.query_one("#title", Static).render())
        # All of the dialog can be seen: the field is its last row.
        field = app.screen.query_one(Input)
        assert field.region.height == 1
        assert app.screen.query_one(".dialog").region.contains_region(field.region)


async def enter_path(pilot: Pilot[None], path: Path) -> None:
    """Begin to type a path, which turns to the field, and give the rest at once."""
    await pilot.press("slash")
    pilot.app.screen.query_one(Input).value = str(path)
    await pilot.press("enter")


async def test_an_image_is_laid_out_by_its_path(tmp_path: Path) -> None:
    path = tmp_path / "red.png"
    Image.new("RGB", (300, 200), (200, 0, 0)).save(path)
    async with Lab(settings(LOGS)).run_test(size=(120, 40)) as pilot:
        app = await ready(pilot)
        await pilot.press("b")
        await pilot.pause()
        await enter_path(pilot, path)
        await until(pilot, lambda: app.bridge.plan.spec.world.background == str(path) and app.loading.mat_is_ready)
        assert app.bridge.snapshot().colors["left"].rgb == (200, 0, 0)


@pytest.mark.parametrize("content", [None, "no picture"], ids=["missing", "text"])
async def test_what_is_no_image_changes_nothing(content: str | None, tmp_path: Path) -> None:
    path = tmp_path / "none.png"
    if content:
        path.write_text(content)
    async with Lab(settings(LOGS)).run_test(size=(120, 40)) as pilot:
        app = await ready(pilot)
        before = app.bridge.plan
        await pilot.press("b")
        await pilot.pause()
        await enter_path(pilot, path)
        await until(pilot, lambda: any("none.png" in notice for notice in notices(app)))
        await until(pilot, lambda: app.bridge.plan == before)
        assert app.loading.mat_is_ready
        assert app.bridge.snapshot().colors["left"].rgb == (255, 255, 255)
