"""The tree of the screen: what its nodes need, and where they are placed."""

from __future__ import annotations

import pytest

from tuisim.app.layout.tree import (
    Axis,
    PanelBox,
    PanelLayout,
    Split,
    compute_ideal_rows,
    count_fair_rows,
    count_min_columns,
    count_min_rows,
    free_rows,
    join_nodes,
    list_panels,
)
from tuisim.app.panels import PANELS

BESIDE = Split(Axis.COLUMNS, ("chart", "output"), (0.5, 0.5))
ABOVE = Split(Axis.ROWS, ("world", BESIDE))


def test_joining_a_single_layout_node_gives_that_node() -> None:
    assert join_nodes(Axis.ROWS, ["chart"]) == "chart"


def test_panels_side_by_side_get_widths_by_their_weights() -> None:
    node = join_nodes(Axis.COLUMNS, ["world", "chart"])
    assert isinstance(node, Split)
    world = PANELS["world"].weight
    chart = PANELS["chart"].weight
    assert node.shares == pytest.approx((world / (world + chart), chart / (world + chart)))


def test_the_fewest_rows_and_columns_of_a_layout_are_added_along_its_axis() -> None:
    assert list_panels(ABOVE) == ("world", "chart", "output")
    assert (
        count_min_columns(ABOVE)
        == count_min_columns(BESIDE)
        == PANELS["chart"].min_cols + PANELS["output"].min_cols
    )
    deepest = max(PANELS["chart"].min_rows, PANELS["output"].min_rows)
    assert count_min_rows(ABOVE) == PANELS["world"].min_rows + deepest


def test_the_fair_rows_of_a_column_count_the_worlds_ideal_rows_at_its_width() -> None:
    assert count_fair_rows(ABOVE, 80) == compute_ideal_rows(80) + max(
        PANELS["chart"].fair_rows, PANELS["output"].fair_rows
    )


def test_a_layout_ranks_the_world_first_and_then_the_panels_asked_for() -> None:
    layout = PanelLayout(wanted=("chart",))
    assert [layout.rank(node) for node in (ABOVE, "chart", "output")] == [-1, 0, 1]


def test_where_rows_are_left_free_panels_with_rows_to_spare_become_lower() -> None:
    boxes = {
        "world": PanelBox(0, 0, 80, 18),
        "output": PanelBox(0, 18, 40, 5),
        "instrumentation": PanelBox(40, 18, 40, 5),
    }
    assert free_rows(boxes, 0) == boxes
    assert free_rows(boxes, 2) == {
        "world": PanelBox(0, 0, 80, 16),
        "output": PanelBox(0, 16, 40, 5),
        "instrumentation": PanelBox(40, 16, 40, 5),
    }
    # No panel is made lower than it can be.
    assert free_rows(boxes, 11) == boxes
