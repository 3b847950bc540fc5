"""The sensor arrays panel."""

from __future__ import annotations

from array import array
from dataclasses import replace

import numpy as np
import pytest
from textual.geometry import Region

from tests.app.app_help import until
from tests.app.panel_help import SPEC, PanelApp, moment, screen_text, small_field
from tests.cases import cases
from tuisim.app.panels.arrays import Arrays
from tuisim.app.render.arrays import find_asked_lines
from tuisim.base.source import Program
from tuisim.engine.core.geometry import Pose
from tuisim.terminal.cell_view import PixelView
from tuisim.terminal.cells import PALETTE_8, PALETTE_16, ColorMode
from tuisim.terminal.picture_mode import PictureMode
from tuisim.terminal.picture_options import CellSet

FIELD = replace(small_field(), sums={20: memoryview(array("I", [305 * 128]) * (320 * 420 * 3))})
PROGRAM = Program(
    "test.py", "while colorLeft.reflected_light_intensity_pc > 5:\n    pass\n", "preloaded"
)
POSE = Pose(100.0, 1000.0, 90.0)


async def shown(size: tuple[int, int], program: Program | None = None) -> tuple[list[Region], str]:
    """Return the places of the discs, and the text of the panel."""
    app = PanelApp(Arrays())
    async with app.run_test(size=size) as pilot:
        app.panel.show(moment(POSE, field=FIELD, program=program, line=1))
        await pilot.pause()
        await pilot.pause()
        assert all(
            app.panel.region.contains_region(view.region) for view in app.panel.query(PixelView)
        )
        return [view.region for view in app.panel.query(PixelView)], "\n".join(screen_text(app))


@cases(
    "size, across",
    {
        "80x24": ((26, 8), True),
        "120x40": ((40, 10), True),
        "200x60": ((44, 12), True),
        "much room": ((40, 18), True),
        "low": ((80, 6), True),
        "narrow": ((20, 30), False),
        "small": ((20, 6), True),
    },
)
async def test_both_sensor_discs_are_whole_and_show_the_programs_values(
    size: tuple[int, int], across: bool
) -> None:
    (left, right), text = await shown(size)

    assert (left.y == right.y) is across
    assert left.size == right.size and left.height >= 4
    assert text.count("50.2") == 2


@pytest.mark.parametrize("size", [(40, 10), (44, 12), (60, 14), (66, 11), (20, 30)])
async def test_means_of_a_discs_rings_are_labelled_the_same_at_every_size(
    size: tuple[int, int],
) -> None:
    assert (await shown(size))[1].count("in→out") == 2


async def test_a_threshold_is_drawn_on_the_scale_and_named_with_its_line() -> None:
    _, text = await shown((60, 14), PROGRAM)

    assert (
        "50.2 %" in text
        and "> 5: yes" in text
        and "┃" in text
        and "code line 1 >" in text
        and "in→out" in text
    )


LOOPS = Program(
    "test.py",
    """\
def back():
    tank_drive.on_for_seconds(-20, -20, 1)
while colorLeft.reflected_light_intensity_pc > 5:
    back()
tank_drive.off()
while True:
    while colorLeft.reflected_light_intensity_pc < 9:
        pass
    tank_drive.on(20, 20)
""",
    "preloaded",
)


@cases(
    "lines, shown",
    {
        "before the run": ([0], {3, 7}),
        "its loop": ([3], {3}),
        "a function that its loop calls": ([3, 2], {3}),
        "after its loop": ([3, 5], set()),
        "a loop in a loop": ([7], {7}),
        "the loop around it": ([7, 9], set()),
    },
)
def test_a_threshold_is_shown_only_while_its_loop_runs(lines: list[int], shown: set[int]) -> None:
    asked: frozenset[int] = frozenset()
    for line in lines:
        asked = find_asked_lines(moment(program=LOOPS, line=line), asked)
    assert asked == shown


async def test_a_threshold_leaves_the_panel_after_its_loop() -> None:
    app = PanelApp(Arrays())
    async with app.run_test(size=(60, 14)) as pilot:
        for line, is_shown in ((3, True), (5, False)):
            app.panel.show(moment(POSE, field=FIELD, program=LOOPS, line=line))
            await pilot.pause()
            await pilot.pause()
            text = "\n".join(screen_text(app))
            assert ("code line 3 > 5" in text, "┃" in text) == (is_shown, is_shown)


@pytest.mark.parametrize(
    "cells", [CellSet.HALF, CellSet.SEXTANT, CellSet.OCTANT, CellSet.BRAILLE, CellSet.ASCII]
)
async def test_discs_use_the_cells_of_the_app(cells: CellSet) -> None:
    app = PanelApp(Arrays())
    app.picture_mode = PictureMode(cells)  # type: ignore[attr-defined]
    async with app.run_test(size=(40, 11)) as pilot:
        app.panel.show(moment(POSE, field=FIELD))
        await pilot.pause()
        await pilot.pause()
        view = app.panel.query(PixelView).first()
        cell = view.choose_cell(None)
        assert view._shown.shape[:2] == (view.size.height * cell.rows, view.size.width * cell.cols)


@pytest.mark.parametrize("depth", [PALETTE_8, PALETTE_16])
async def test_with_few_colours_the_surroundings_of_a_disc_are_plain_and_darker(
    depth: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(PixelView, "color_mode", ColorMode(depth))
    app = PanelApp(Arrays())
    async with app.run_test(size=(40, 11)) as pilot:
        app.panel.show(moment(POSE, field=FIELD))
        await until(pilot, lambda: any(view._shown.size for view in app.panel.query(PixelView)))
        picture = app.panel.query(PixelView).first()._shown @ np.array([0.299, 0.587, 0.114])
    high, wide = picture.shape
    # In the middle is the edge between red and white, the left half lies on the former.
    disc = picture[high // 2 - 2 : high // 2 + 2, wide // 2 + 1 : wide // 2 + 3]
    corner = picture[:1, :1]
    assert np.ptp(corner) == 0
    assert corner.max() < disc.mean()


async def test_discs_are_drawn_again_only_for_another_pose_or_robot() -> None:
    app = PanelApp(Arrays())
    one = replace(SPEC, robot=replace(SPEC.robot, color_sensors=SPEC.robot.color_sensors[:1]))
    async with app.run_test(size=(40, 11)) as pilot:
        app.panel.show(moment(POSE, field=FIELD))
        await pilot.pause()
        drawn: list[object] = []
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(PixelView, "set_fine_picture", lambda *given: drawn.append(given))
            app.panel.show(moment(POSE, field=FIELD, time_s=99.0))
        assert not drawn
        app.panel.show(moment(POSE, field=FIELD, spec=one))
        await pilot.pause()
        (view,) = app.panel.query(PixelView)
        assert view._cells.size > 0
        app.panel.show(moment(POSE, spec=one))
        assert view._cells.size == 0


async def test_the_panel_of_discs_says_so_if_the_robot_has_no_colour_sensor() -> None:
    app = PanelApp(Arrays())
    async with app.run_test(size=(40, 10)) as pilot:
        now = moment(POSE, field=FIELD)
        robot = replace(now.spec.robot, color_sensors=())
        app.panel.show(replace(now, spec=replace(now.spec, robot=robot)))
        await pilot.pause()
        text = "\n".join(screen_text(app))
        assert "no colour sensor" in text
        assert "mat" not in text
        app.panel.show(now)
        await pilot.pause()
        assert "no colour sensor" not in "\n".join(screen_text(app))
