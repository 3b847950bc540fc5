"""Where panels go: every size of terminal is filled without overlap."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from tests.cases import for_each
from tuisim.app.layout.arrangement import (
    Preset,
    arrange,
    arrange_beside_world,
    choose_panels,
)
from tuisim.app.layout.tree import EDGES, PanelBox
from tuisim.app.panels import PANELS

SIZES = [(80, 23), (80, 40), (100, 30), (120, 39), (132, 43), (200, 59), (237, 70), (60, 18)]


def assert_fills(boxes: dict[str, PanelBox], width: int, height: int) -> None:
    covered = np.zeros((height, width), dtype=int)
    for box in boxes.values():
        assert (
            0 <= box.x
            and box.x + box.width <= width
            and 0 <= box.y
            and box.y + box.height <= height
        )
        covered[box.y : box.y + box.height, box.x : box.x + box.width] += 1
    assert (covered == 1).all()


@pytest.mark.quick_cases("60x18")
@pytest.mark.parametrize("width, height", SIZES, ids=[f"{w}x{h}" for w, h in SIZES])
def test_any_set_of_panels_fills_the_screen_with_their_fewest_rows(width: int, height: int) -> None:
    for count in range(1, len(PANELS) + 1):
        for panels in itertools.islice(itertools.combinations(PANELS, count), 40):
            placed = arrange(panels, width, height)
            assert set(placed.boxes) | set(placed.left_out) == set(panels)
            assert_fills(placed.boxes, width, height)
            for panel, box in placed.boxes.items():
                assert box.height >= PANELS[panel].min_rows, panels


@pytest.mark.parametrize(
    "size, expected",
    [
        ((80, 24), {"world", "instrumentation", "output"}),
        ((100, 30), {"world", "instrumentation", "output", "arrays", "chart"}),
        ((120, 40), {"world", "instrumentation", "output", "arrays", "chart", "code"}),
        ((200, 60), {panel.id for panel in PANELS.values() if panel.sizes}),
    ],
    ids=["80x24", "100x30", "120x40", "200x60"],
)
def test_each_terminal_size_has_its_panels_at_first(
    size: tuple[int, int], expected: set[str]
) -> None:
    width, height = size[0], size[1] - 1
    placed = arrange(choose_panels(Preset.STANDARD, {}, width, height)[0], width, height)
    assert set(placed.boxes) == expected
    assert not placed.left_out


def test_in_a_full_layout_the_readings_get_at_least_their_fewest_rows() -> None:
    placed = arrange(["arrays", "controls", "instrumentation", "world"], 80, 23)
    assert {"arrays", "controls", "instrumentation"} <= set(placed.boxes)
    assert placed.boxes["instrumentation"].height == PANELS["instrumentation"].min_rows


@pytest.mark.parametrize("width, height", [(200, 59), (220, 64), (237, 70), (300, 99)])
def test_a_wide_screen_shows_whole_lines_of_code_beside_a_chart(width: int, height: int) -> None:
    panels, fill = choose_panels(Preset.STANDARD, {}, width, height)
    boxes = arrange(panels, width, height, fill).boxes
    assert boxes["chart"].width >= 74 and boxes["code"].width >= 80
    assert boxes["output"].width >= PANELS["output"].min_cols
    assert boxes["world"].width >= 3 * width // 4


@pytest.mark.parametrize("panel", ["debug", "noise", "lesson", "arrays"])
@pytest.mark.parametrize("width, height", [(65, 52), (65, 49), (48, 44), (78, 62)])
def test_the_world_is_on_top_of_a_phone_in_the_whole_width(
    panel: str, width: int, height: int
) -> None:
    panels, fill = choose_panels(Preset.STANDARD, {panel: True}, width, height)
    placed = arrange(panels, width, height, fill)
    world = placed.boxes["world"]
    assert (world.x, world.y, world.width) == (0, 0, width)
    assert panel in placed.boxes


ROWS_WITH_POSE = 5
"""Rows of the readings in which x, y and heading are in sight, in a low terminal of 80 columns."""
LOW_SIZES = pytest.mark.parametrize("width, height", [(80, 23), (100, 28), (72, 24)])


@LOW_SIZES
def test_the_world_has_the_whole_width_of_a_low_terminal(width: int, height: int) -> None:
    boxes = arrange(["world", "instrumentation", "output"], width, height).boxes
    assert boxes["world"].width == width
    assert boxes["instrumentation"].y == boxes["output"].y == boxes["world"].height


@LOW_SIZES
@pytest.mark.parametrize("panel, rows", [("chart", 13), ("code", 11)])
def test_a_chart_or_code_panel_fits_beside_the_others_in_a_low_terminal(
    panel: str, rows: int, width: int, height: int
) -> None:
    placed = arrange(["world", panel, "instrumentation", "output"], width, height)
    assert not placed.left_out
    assert placed.boxes[panel].width == width and placed.boxes[panel].height >= rows
    readings = placed.boxes["instrumentation"]
    assert readings.y == placed.boxes["world"].y == 0
    assert readings.height >= ROWS_WITH_POSE


def test_if_only_chart_or_code_fits_the_one_asked_for_first_is_shown() -> None:
    placed = arrange(["world", "chart", "code", "instrumentation", "output"], 80, 23)
    assert placed.left_out == ("code",)


@for_each(height=range(14, 23))
def test_a_chart_is_laid_out_from_16_rows_on(height: int) -> None:
    assert ("chart" in arrange(["world", "chart"], 80, height).boxes) is (height >= 16)


def test_the_settings_panel_leaves_room_for_all_readings_in_a_small_terminal() -> None:
    boxes = arrange(["settings", "world", "instrumentation", "output"], 80, 23).boxes
    assert (
        boxes["instrumentation"].height >= 8
        and boxes["settings"].height >= PANELS["settings"].fair_rows
    )


@pytest.mark.parametrize("size", [(100, 29), (112, 33), (120, 39), (150, 45)], ids=str)
def test_the_board_shows_a_chart_that_can_be_read(size: tuple[int, int]) -> None:
    boxes = arrange(choose_panels(Preset.STANDARD, {}, *size)[0], *size).boxes
    assert boxes["chart"].width >= 50 and boxes["chart"].height >= 10
    assert boxes["instrumentation"].height >= 8 and boxes["output"].height >= 3
    assert ("code" in boxes) is (size[0] >= 120)


@pytest.mark.parametrize("size", [(100, 29), (112, 39)], ids=str)
def test_a_stop_at_a_line_shows_code_and_variables(size: tuple[int, int]) -> None:
    asked = {"code": True, "debug": True}
    placed = arrange(choose_panels(Preset.STANDARD, asked, *size)[0], *size)
    assert set(placed.boxes) == {"world", "instrumentation", "output", "code", "debug"}
    assert placed.boxes["code"].width == size[0]


@pytest.mark.parametrize("width, height", [(65, 57), (60, 60), (72, 50)])
def test_a_tall_terminal_shows_code_and_chart_at_first(width: int, height: int) -> None:
    wanted, fill = choose_panels(Preset.STANDARD, {}, width, height)
    boxes = arrange(wanted, width, height, fill).boxes
    assert {"code", "chart"} <= boxes.keys() and not {"positioning", "noise"} & boxes.keys()
    assert boxes["code"].height >= 9 and boxes["chart"].height >= 10


def test_the_editor_stands_beside_the_world() -> None:
    wanted = ["world", "instrumentation", "output", "arrays", "chart"]
    assert arrange_beside_world("code", wanted, 109, 39) is None
    assert arrange_beside_world("code", ["lesson", *wanted], 120, 39) is None
    for width, height in ((110, 29), (120, 39), (150, 45)):
        layout = arrange_beside_world("code", wanted, width, height)
        assert layout is not None and {"code", "world", "output"} <= layout.boxes.keys()
        assert_fills(layout.boxes, width, height)
        assert layout.boxes["code"].height == height
        assert layout.boxes["code"].width >= 68 and layout.boxes["world"].width >= 42


def test_each_panel_has_its_own_key() -> None:
    assert len({panel.key for panel in PANELS.values()}) == len(PANELS)


@pytest.mark.parametrize("width", [40, 50, 59])
def test_a_narrow_and_high_area_shows_the_world_above_what_was_asked_for(width: int) -> None:
    boxes = arrange(["world", "goals", "instrumentation"], width, 44).boxes
    assert {"world", "goals"} <= boxes.keys()
    assert boxes["world"].width == width
    assert boxes["world"].y == 0


@for_each(
    asked=["chart", "code", "brick", "lesson", "controls"],
    size=[(80, 23), (100, 29), (120, 39), (200, 59), (65, 57)],
)
def test_three_rows_of_the_output_stay_beside_a_panel_that_is_asked_for(
    size: tuple[int, int], asked: str
) -> None:
    wanted, fill = choose_panels(Preset.STANDARD, {asked: True}, *size)
    boxes = arrange(wanted, *size, fill).boxes
    assert boxes["output"].height - EDGES >= 3
    assert asked in boxes
