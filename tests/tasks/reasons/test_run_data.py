"""What a run recorded, as those see it who look for reasons."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tasks.reasons.runs import run_text
from tuisim.engine.core.commands.calls import Call
from tuisim.tasks.reasons.run_data import RunData, describe_place, list_distinct

DRIVES = """\
# %%sim_magic_preloaded -b Grey_bands
tank_drive.on(SpeedPercent(50), SpeedPercent(50))
while colorLeft.reflected_light_intensity_pc > 95:
    pass
tank_drive.off()
"""


def test_values_are_those_that_the_loop_read_and_would_have_read_elsewhere() -> None:
    data = RunData(run_text(DRIVES))
    (loop,) = data.facts.loop_ends
    series = data.measure(loop, (0, len(data.records)))
    assert series is not None
    assert (series.device, series.unit) == ("colorLeft on in2", " %")
    assert series.values[0] == 100 and series.values[-1] <= 95 < series.values[-2]
    assert list(series.ticks) == list(data.light_ticks["left"])
    later = data.records[-1:].copy()
    later["x_mm"] = 1432
    elsewhere = data.measure_records(loop, later, np.array([0]))
    assert elsewhere is not None and elsewhere.values[0] == pytest.approx(0, abs=1)
    assert data.measure_ticks(loop, np.array([], int)) is None


def test_the_commands_have_their_ticks() -> None:
    data = RunData(run_text(DRIVES))
    starts = data.command_ticks[data.commands["call"] == Call.RUN]
    stops = data.command_ticks[data.commands["call"] == Call.STOP]
    assert list(starts) == [0, 0]
    assert stops[-1] == pytest.approx(len(data.records) - 1, abs=1)


def test_a_gyro_in_a_hub_has_no_port() -> None:
    assert describe_place("in1") == "on in1"
    assert describe_place("inside") == "in the hub"


def test_a_line_number_that_no_program_has_takes_no_memory() -> None:
    lines = np.array([3, 1, 0xFFFFFFFF, 3], np.uint32)
    assert list_distinct(lines).tolist() == [1, 3, 0xFFFFFFFF]
    assert list_distinct(lines[:0]).tolist() == []
