"""Cells and what changed between frames."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tuisim.app.render.cells import changed_runs, to_cells


def test_a_cell_holds_upper_and_lower_colour() -> None:
    picture = np.array([[[1, 2, 3]], [[4, 5, 6]]], np.uint8)

    assert to_cells(picture).tolist() == [[0x010203_040506]]


@pytest.mark.parametrize(
    ("changed", "runs"),
    [
        pytest.param([], [], id="nothing"),
        pytest.param([4], [(0, 4, 1)], id="one cell"),
        pytest.param([2, 5], [(0, 2, 4)], id="a gap of two is joined"),
        pytest.param([2, 6], [(0, 2, 1), (0, 6, 1)], id="a gap of three is not"),
        pytest.param([9, 10], [(0, 9, 1), (1, 0, 1)], id="rows are apart"),
    ],
)
def test_changed_runs(changed: list[int], runs: list[tuple[int, int, int]]) -> None:
    old = np.zeros((3, 10), np.int64)
    new = old.copy()
    new.flat[changed] = 1

    assert changed_runs(old, new) == runs


@given(st.lists(st.booleans(), min_size=60, max_size=60))
def test_runs_hold_every_change_and_do_not_touch(changed: list[bool]) -> None:
    old = np.zeros((3, 20), np.int64)
    new = np.array(changed, np.int64).reshape(3, 20)
    covered = np.zeros((3, 20), int)

    for row, first, length in changed_runs(old, new):
        covered[row, first : first + length] += 1

    assert covered.max() <= 1
    assert covered[new != old].all()
