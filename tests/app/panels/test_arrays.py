"""The sensor arrays panel."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from tests.app.panel_help import PanelApp, moment, screen_text, small_field
from tuisim.app.panels.arrays import Arrays, name_line
from tuisim.core.field import Field
from tuisim.core.geometry import Pose
from tuisim.scene.discs import lay_out
from tuisim.terminal.cell_view import PixelView
from tuisim.terminal.cells import PALETTE_8, PALETTE_16, ColorMode

FIELD = small_field()


@pytest.mark.parametrize(
    ("size", "names"),
    [
        pytest.param((40, 11), ["Sensor1 left", "Sensor2 right"], id="with names"),
        pytest.param((44, 14), ["Sensor1 left", "Sensor2 right"], id="with room"),
        pytest.param((40, 10), [], id="just the discs"),
        pytest.param((20, 6), [], id="small"),
        pytest.param((24, 20), [], id="stacked"),
    ],
)
async def test_discs_and_names(size: tuple[int, int], names: list[str]) -> None:
    app = PanelApp(Arrays())
    async with app.run_test(size=size) as pilot:
        app.panel.show(moment(Pose(100.0, 1000.0, 90.0), field=FIELD))
        await pilot.pause()
        shown = app.panel.query_one(PixelView)._shown
        text = "\n".join(screen_text(app))

    # The left disc lies on red, the right one on white.
    assert (shown.reshape(-1, 3) == shown[shown.shape[0] // 2, shown.shape[1] // 2]).any()
    assert len({tuple(pixel) for pixel in shown.reshape(-1, 3).tolist()}) >= 3
    assert all(name in text for name in names)
    assert bool(app.panel.border_subtitle) == (not names)


@pytest.mark.parametrize("depth", [PALETTE_8, PALETTE_16])
async def test_with_few_colours_what_is_around_a_disc_is_plain_and_darker(
    depth: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(PixelView, "color_mode", ColorMode(depth))
    app = PanelApp(Arrays())
    grey = Field(400, 300, memoryview(bytes([128]) * (3 * 300 * 400)), {})
    async with app.run_test(size=(40, 11)) as pilot:
        app.panel.show(moment(Pose(200.0, 1000.0, 90.0), field=grey))
        await pilot.pause()
        shown = app.panel.query_one(PixelView)._shown @ np.array([0.299, 0.587, 0.114])
    disc, corner = shown[8:12, 8:12], shown[:2, :2]
    assert np.ptp(corner) == 0
    assert corner.max() < disc.mean()


@pytest.mark.parametrize(
    "names",
    [["left", "right"], ["one"], ["left", "middle", "right"], ["at the far left", "at the far right"]],
    ids=["two", "one", "three", "long"],
)
def test_names_never_run_together(names: list[str]) -> None:
    for width in range(4 * len(names), 90):
        layout = lay_out(len(names), width, 20)
        if not layout.beside:
            continue
        line = name_line(layout, names)
        boxes = [line[col : col + layout.side_px] for col, _ in layout.corners]
        assert len(line) <= width and "".join(boxes).replace(" ", "") == line.replace(" ", ""), width
        assert all(box.strip()[:1] in (name[0], "S") for box, name in zip(boxes, names, strict=True)), width
        for box, after in pairwise(boxes):
            assert box.endswith(" ") or after.startswith(" "), width


async def test_without_a_mat_it_is_blank() -> None:
    app = PanelApp(Arrays())
    async with app.run_test(size=(40, 11)) as pilot:
        app.panel.show(moment(field=FIELD))
        await pilot.pause()
        app.panel.show(moment())
        app.panel._throttle.now()

        assert app.panel.query_one(PixelView)._cells.size == 0


async def test_the_same_pose_is_not_drawn_again(monkeypatch: pytest.MonkeyPatch) -> None:
    app = PanelApp(Arrays())
    async with app.run_test(size=(40, 11)) as pilot:
        app.panel.show(moment(field=FIELD))
        await pilot.pause()
        drawn: list[object] = []
        monkeypatch.setattr(app.panel.query_one(PixelView), "set_picture", drawn.append)

        app.panel.show(moment(field=FIELD, time_s=99.0))
        app.panel._throttle.now()

        assert not drawn
