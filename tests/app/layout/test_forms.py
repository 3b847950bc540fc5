"""The forms of the screen: which panels stand beside, below and above each other."""

from __future__ import annotations

import pytest

from tests.cases import for_each
from tuisim.app.layout.forms import build_below, build_board, build_wide, count_tight_rows
from tuisim.app.layout.tree import (
    Axis,
    PanelBox,
    PanelLayout,
    Split,
    count_min_rows,
    list_panels,
    place,
)

BOARD = ("world", "instrumentation", "arrays", "output", "chart")


def boxes_of(node: str | Split, width: int, height: int) -> dict[str, PanelBox]:
    layout = PanelLayout()
    place(node, PanelBox(0, 0, width, height), layout)
    return layout.boxes


@pytest.mark.parametrize("size", [(100, 29), (120, 39), (160, 47)], ids=str)
def test_a_board_has_readings_beside_the_world_and_the_chart_below(size: tuple[int, int]) -> None:
    boxes = boxes_of(build_board(BOARD, *size), *size)
    assert boxes["instrumentation"].x == boxes["arrays"].x == boxes["world"].width
    assert boxes["chart"].y == boxes["output"].y == boxes["world"].height
    assert boxes["chart"].width > boxes["output"].width


def test_code_stands_beside_chart_and_output() -> None:
    boxes = boxes_of(build_board((*BOARD, "code"), 120, 39), 120, 39)
    assert boxes["code"].height == boxes["chart"].height + boxes["output"].height
    assert boxes["chart"].x == boxes["output"].x == boxes["code"].width


@pytest.mark.parametrize("panels", [BOARD[:4], (*BOARD, "lesson"), (*BOARD, "settings")], ids=str)
def test_panels_without_room_for_a_board_are_laid_out_with_a_side_column(
    panels: tuple[str, ...],
) -> None:
    assert build_board(panels, 100, 29) == build_wide(panels, 100, 29)


@for_each(panel=["noise", "positioning", "debug"], size=[(80, 23), (100, 29), (120, 39)])
def test_a_lesson_keeps_its_column_beside_a_panel_that_it_asks_for(
    panel: str, size: tuple[int, int]
) -> None:
    boxes = boxes_of(build_wide(("lesson", "world", "code", panel), *size), *size)
    assert boxes["lesson"].height == size[1]
    assert boxes[panel].x < boxes["lesson"].x


def test_panels_in_one_column_get_their_fewest_readable_rows() -> None:
    panels = ("world", "instrumentation", "arrays", "output", "code", "chart")
    rows = count_tight_rows(panels, 65)
    node = build_below(panels, 65, sum(rows))
    assert isinstance(node, Split) and node.axis is Axis.ROWS
    assert {name: box.height for name, box in boxes_of(node, 65, sum(rows)).items()} == dict(
        zip(list_panels(node), count_tight_rows(list_panels(node), 65), strict=True)
    )
    assert count_min_rows(build_below(panels, 65, sum(rows) - 1)) < sum(rows)
