"""Recordings folded and unfolded."""

from __future__ import annotations

import numpy as np

from tuisim.runs import packed_codec
from tuisim.runs.packed_codec import TICK


def test_every_bit_comes_back_of_what_no_motion_makes() -> None:
    chance = np.random.default_rng(4)
    for count in (0, 1, 2, 3, 500):
        records = chance.bytes(count * TICK.itemsize)
        assert packed_codec.unfold_ticks(packed_codec.fold_ticks(records), count) == records
    special = np.zeros(8, TICK)
    special["x_mm"] = [0.0, -0.0, np.nan, np.inf, -np.inf, 5e-324, 1.7e308, -1.7e308]
    special["left_speed_dps"] = [0.0, -0.0, np.nan, np.inf, -np.inf, 1e-45, 3e38, -3e38]
    assert (
        packed_codec.unfold_ticks(packed_codec.fold_ticks(special.tobytes()), 8)
        == special.tobytes()
    )
