"""Stretches of arrays."""

from __future__ import annotations

import numpy as np
import pytest

from tuisim.engine.runs.arrays import find_spans


@pytest.mark.parametrize(
    "text, spans",
    [
        ("", []),
        ("...", []),
        ("###", [[0, 3]]),
        ("#..##.", [[0, 1], [3, 5]]),
        (".##.#", [[1, 3], [4, 5]]),
    ],
)
def test_find_spans_gives_start_and_end_of_each_run_of_true_values(
    text: str, spans: list[list[int]]
) -> None:
    assert find_spans(np.array([letter == "#" for letter in text], np.bool_)).tolist() == spans
