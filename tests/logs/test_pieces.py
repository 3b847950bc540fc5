"""Pieces of a log, and the steps between them."""

from __future__ import annotations

import numpy as np
import pytest

from tests.cases import for_each
from tuisim.logs import pieces
from tuisim.logs.pieces import Signal, find_strays


@for_each(seed=range(40))
def test_steps_between_pieces_are_those_of_least_squares(seed: int) -> None:
    rng = np.random.default_rng(seed)
    edge = int(rng.integers(1, 13))
    gap = int(rng.integers(0, 3))
    stop = edge + gap + int(rng.integers(1, 13))
    values = rng.normal(0.0, 1.0, stop) + 50.0
    values[rng.random(stop) < 0.2] += 1000.0
    before, after = np.array([[0, edge]]), np.array([[edge + gap, stop]])
    signal = Signal(values, range=1000.0, noise=1.0, sigma=1.0, min_step=0.0)
    lines = [pieces._fit_lines(signal, span) for span in (before, after)]
    step, spread = pieces._estimate_steps(*lines)

    kept = [
        ~find_strays(values[None, start:end], 1.0)[0]
        for start, end in ((0, edge), (edge + gap, stop))
    ]
    at = np.concatenate((np.flatnonzero(kept[0]), edge + gap + np.flatnonzero(kept[1])))
    model = np.stack((np.ones(len(at)), at - edge, at >= edge), axis=1).astype(np.float64)
    inverse = np.linalg.pinv(model)
    assert step == pytest.approx([float(inverse[2] @ values[at])])
    assert spread == pytest.approx([float(np.linalg.norm(inverse[2]))])


def test_a_single_stray_sample_is_found_beside_a_drift() -> None:
    part = np.stack((np.arange(20.0), np.where(np.arange(20) == 7, 30.0, 5.0)))
    off = find_strays(part, 1.0)
    assert np.argwhere(off).tolist() == [[1, 7]]
