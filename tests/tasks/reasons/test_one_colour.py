"""What a program saw with every light sensor that it read."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tasks.reasons.runs import run_text
from tuisim.tasks.reasons.one_colour import OneColor, find_one_color

TEXT = """\
# %%sim_magic_preloaded -b Grey_bands -x {x} -y 500
tank_drive.on_for_seconds(SpeedPercent(40), SpeedPercent(40), {seconds})
"""


@pytest.mark.parametrize(
    "x, seconds, reads, seen",
    [
        (2200, 2.0, 200, None),
        (1750, 5.0, 500, OneColor(1, "left", "white", 304)),
        (620, 1.0, 200, None),
        (1750, 2.0, 200, OneColor(1, "left", "white")),
        (1750, 2.0, 10, None),
        (1750, 0.5, 200, None),
    ],
    ids=["off the mat", "white, then off the mat", "two greys", "white", "seldom", "a short way"],
)
def test_a_sensor_that_saw_one_colour_on_a_long_way_is_named(
    x: int, seconds: float, reads: int, seen: OneColor | None
) -> None:
    run = run_text(TEXT.format(x=x, seconds=seconds))
    records = run.telemetry.array()
    every = np.arange(1, len(records), max(1, len(records) // reads))
    ticks = {"left": every, "right": every[:0]}
    assert find_one_color(records, run.spec, run.open_mat(), ticks) == seen
