"""The app draws the world and the sensor arrays with pixels where the terminal can."""

from __future__ import annotations

import gc
import re
from typing import Any

import numpy as np
import pytest
from textual.geometry import Region

from tests.app.app_help import lab, notices, settings, until
from tests.app.panel_help import PanelApp
from tests.app.wires import on_wire, until_quiet, wire_of
from tests.terminal.pixel_help import ANSWERS, answered, drawn_by, part_of, seen_on, sharp
from tuisim.app.app import LabApp
from tuisim.app.panels.arrays import Arrays
from tuisim.app.panels.world import WorldView
from tuisim.terminal.cell_view import PixelView
from tuisim.terminal.picture_mode import PictureMode, Sharpness
from tuisim.terminal.picture_options import AUTO, CellSet, Protocol
from tuisim.terminal.queries import ATTRIBUTES_QUERY, CELL_SIZE_QUERY, KITTY_QUESTIONS


@pytest.mark.quick_cases("kitty")
@pytest.mark.parametrize("protocol", Protocol)
async def test_each_graphics_protocol_shows_the_drawn_pixels(protocol: Protocol) -> None:
    async with on_wire(LabApp(settings()), "truecolor") as pilot:
        await answered(pilot, ANSWERS[protocol])
        for key in ("right", "a", "a", "up"):
            await pilot.press(key)
        for view in (
            pilot.app.query_one(WorldView),
            pilot.app.query_one(Arrays).query_one(PixelView),
        ):
            await sharp(pilot, view)
            assert np.array_equal(part_of(seen_on(pilot), view), drawn_by(view, protocol))


def _around(shown: PixelView, hidden: Region, points: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """Return an image of a view without the cells that something hides."""
    seen = points.copy()
    x, y, width, height = hidden.translate(-shown.content_region.offset)
    seen[max(y, 0) * 16 : max(y + height, 0) * 16, max(x, 0) * 8 : max(x + width, 0) * 8] = 0
    return seen


@pytest.mark.slow
@pytest.mark.parametrize("protocol", Protocol)
async def test_closing_a_dialog_restores_the_pixel_picture_below_it(protocol: Protocol) -> None:
    async with on_wire(LabApp(settings()), "truecolor") as pilot:
        await answered(pilot, ANSWERS[protocol])
        world = pilot.app.query_one(WorldView)
        await sharp(pilot, world)
        await pilot.press("b")
        await until_quiet(pilot)
        frame = pilot.app.screen.query_one(".dialog").region
        seen = part_of(seen_on(pilot), world)
        drawn = drawn_by(world, protocol)
        assert frame.overlaps(world.content_region)
        assert not np.array_equal(seen, drawn)
        assert np.array_equal(_around(world, frame, seen), _around(world, frame, drawn))
        await pilot.press("escape")
        await sharp(pilot, world)
        assert np.array_equal(part_of(seen_on(pilot), world), drawn_by(world, protocol))


@pytest.mark.slow
async def test_a_resized_terminal_is_asked_for_the_size_of_its_cells() -> None:
    async with on_wire(LabApp(settings()), "truecolor") as pilot:
        await answered(pilot, ANSWERS[Protocol.SIXEL])
        wire_of(pilot).sent.clear()
        await pilot.resize_terminal(110, 36)
        await until(pilot, lambda: CELL_SIZE_QUERY + ATTRIBUTES_QUERY in wire_of(pilot).sent)


@pytest.mark.slow
async def test_kitty_is_asked_for_what_is_used_and_is_told_to_report_errors() -> None:
    async with on_wire(LabApp(settings()), "truecolor") as pilot:
        await answered(pilot, ANSWERS[Protocol.KITTY].partition("\x1b_G")[0])
        assert KITTY_QUESTIONS in wire_of(pilot).sent
        assert pilot.app.query_one(WorldView)._tiles is None
        await answered(pilot, ANSWERS[Protocol.KITTY])
        codes = "".join(wire_of(pilot).sent)
        commands = re.findall(r"\x1b_G([^;\x1b]*)", codes)
        assert all("U=1" in one.split(",") for one in commands if "a=q" in one.split(","))
        assert all("q=1" in one.split(",") for one in commands if "a=T" in one.split(","))


@pytest.mark.slow
async def test_an_error_from_kitty_switches_pictures_back_to_characters() -> None:
    async with on_wire(LabApp(settings()), "truecolor") as pilot:
        await answered(pilot, ANSWERS[Protocol.KITTY])
        await sharp(pilot, pilot.app.query_one(WorldView))
        await answered(pilot, ANSWERS[Protocol.KITTY] + "\x1b_Gi=1;ENOSPC:No space left\x1b\\")
        assert pilot.app.query_one(WorldView)._tiles is None
        seen = seen_on(pilot)
        assert not seen.pixels.any(), "a picture is still in sight"
        assert any("ENOSPC:No space left" in message for message in notices(lab(pilot)))


@pytest.mark.slow
async def test_one_key_switches_pictures_to_characters_and_back_to_pixels() -> None:
    async with on_wire(LabApp(settings()), "truecolor") as pilot:
        await answered(pilot, ANSWERS[Protocol.SIXEL])
        assert any(action.id == "pixels" for action in lab(pilot).key_footer._actions)
        await pilot.press("number_sign")
        assert pilot.app.query_one(WorldView)._tiles is None
        await pilot.press("number_sign")
        assert pilot.app.query_one(WorldView)._tiles is not None


@pytest.mark.slow
async def test_with_no_color_set_no_pixel_graphics_are_sent(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("NO_COLOR", "1")
    async with on_wire(LabApp(settings()), "truecolor") as pilot:
        await answered(pilot, ANSWERS[Protocol.SIXEL])
        assert pilot.app.query_one(WorldView)._tiles is None


@pytest.mark.slow
async def test_glyphs_that_the_user_has_chosen_are_shown_instead_of_pixels() -> None:
    async with on_wire(LabApp(settings()), "truecolor") as pilot:
        await answered(pilot, ANSWERS[Protocol.SIXEL])
        lab(pilot).choose_cells(CellSet.HALF)
        await until_quiet(pilot)
        assert pilot.app.query_one(WorldView)._tiles is None
        lab(pilot).choose_cells(AUTO)
        await sharp(pilot, pilot.app.query_one(WorldView))


@pytest.mark.quick_cases("kitty")
@pytest.mark.parametrize("protocol", Protocol)
async def test_on_a_slow_link_a_moving_picture_is_sent_in_half_blocks(
    protocol: Protocol, monkeypatch: pytest.MonkeyPatch
) -> None:
    async with on_wire(LabApp(settings()), "truecolor") as pilot:
        await answered(pilot, ANSWERS[protocol])
        world = pilot.app.query_one(WorldView)
        await sharp(pilot, world)
        await pilot.press("right")
        await until_quiet(pilot)
        wire_of(pilot).sent.clear()
        lab(pilot).picture_mode.is_slow = lambda: True
        with monkeypatch.context() as patch:
            patch.setattr(Sharpness, "is_still", False)
            await pilot.press("right")
            await until(pilot, lambda: world._tiles is not None and world._tiles.is_coarse)
            await until(pilot, lambda: "▀" in "".join(wire_of(pilot).sent))
            assert len("".join(wire_of(pilot).sent)) < 4_000
            wire_of(pilot).sent.clear()
        await sharp(pilot, world)
        assert len("".join(wire_of(pilot).sent)) < 20_000


@pytest.mark.slow
async def test_kitty_keeps_no_images_of_pictures_that_have_gone() -> None:
    async with on_wire(LabApp(settings()), "truecolor") as pilot:
        await answered(pilot, ANSWERS[Protocol.KITTY])
        await sharp(pilot, pilot.app.query_one(WorldView))
        assert seen_on(pilot).images
        lab(pilot).choose_cells(CellSet.HALF)
        await until_quiet(pilot)
        gc.collect()
        await pilot.press("question_mark")
        await until_quiet(pilot)
        assert not seen_on(pilot).images


async def test_a_robot_that_has_passed_leaves_no_trace_on_an_edge() -> None:
    """A pale edge looks the same after the robot has been on it."""
    view = PixelView()
    async with PanelApp(view).run_test(size=(4, 2)) as pilot:
        view.picture_mode = PictureMode(CellSet.OCTANT)
        edge = np.full((8, 8, 3), 220, np.uint8)
        edge[:, 0] = 237
        view.set_fine_picture(edge)
        before = view._cells.copy()
        passing = edge.copy()
        passing[2:6, :3] = (0, 95, 215)
        view.set_fine_picture(passing)
        view.set_fine_picture(edge)
        await pilot.pause()
        assert np.array_equal(view._cells, before)
