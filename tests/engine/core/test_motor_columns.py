"""What drivers know of the motors: the same records however ticks are divided, and columns from them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from random import Random

import pytest

from tests.engine.core.driver.test_simulated import Lab
from tuisim.base.errors import ConfigError
from tuisim.engine.core.motor_columns import (
    MOTOR_RECORD,
    build_motor_columns,
    name_motors,
)
from tuisim.engine.core.profile import PROFILES
from tuisim.engine.core.sensors import find_named_column, list_column_names
from tuisim.engine.core.spec import MotorSpec, RobotSpec, RunSpec, WorldSpec

RUN = RunSpec(RobotSpec(extra_motors=(MotorSpec("outA"),)), WorldSpec(), PROFILES["ev3"])
STATES = ("running", "ramping", "holding", "stalled", "overloaded")


class Memory:
    """Keeps the records of motors."""

    def __init__(self) -> None:
        self.data = bytearray(1 << 20)

    def extend_buffer(self, ticks: int) -> bytearray:
        """Return the same buffer: it is larger than any test needs."""
        return self.data

    def arrange(self, sources: Sequence[int | None], ticks: int) -> None:
        """Refuse: the motors of these tests stay the same."""
        raise AssertionError(sources)


def record(seed: int, most: int, looks: Random | None = None) -> tuple[Lab, bytes]:
    lab = Lab(seed=seed)
    memory = Memory()
    lab.sim.restart(lab.sim.spec, lab.sink, memory)
    lab.run(seed, most, looks)
    return lab, bytes(memory.data)


@pytest.mark.parametrize("seed", range(3))
def test_motor_columns_do_not_depend_on_how_ticks_are_grouped_or_who_reads(seed: int) -> None:
    _, whole = record(seed, 200)
    assert record(seed, 1)[1] == whole
    assert record(seed, 7, Random(seed))[1] == whole
    assert any(whole)


def test_motor_values_in_an_instant_equal_the_recorded_ones() -> None:
    lab, data = record(3, 50)
    size = MOTOR_RECORD.size * 3
    end = 64 + size * lab.sink.count
    assert lab.sim.motor_values == tuple(MOTOR_RECORD.iter_unpack(data[end - size : end]))
    assert lab.sim.build_instant(with_motors=True).motors == lab.sim.motor_values
    assert lab.sim.build_instant().motors == ()


def test_a_run_has_columns_of_its_motors_only_where_they_have_drivers() -> None:
    assert name_motors(RUN.robot) == ("left", "right", "motor_a")
    names = list_column_names(RUN)
    assert {"left_asked_dps", "right_measured_dps", "motor_a_duty_pc", "left_state"} < {*names}
    assert {f"motor_a_{state}" for state in STATES} < {*names}
    browser = replace(RUN, profile=PROFILES["robolab"])
    assert not {
        name for name in list_column_names(browser) if name.endswith(("_duty_pc", "_state"))
    }
    assert find_named_column("left duty pc", RUN) == "left_duty_pc"
    with pytest.raises(ConfigError) as refused:
        find_named_column("left_holding", browser)
    assert refused.value.hint == "only profile ev3 has it"


@pytest.mark.parametrize("bit, state", [*enumerate(STATES)])
def test_the_column_of_a_motors_state_is_1_while_it_applies(bit: int, state: str) -> None:
    column = next(one for one in build_motor_columns("left") if one.name == f"left_{state}")
    assert column.of is not None
    rows = [(0.0, 0.0, 0.0, float(1 << bit)), (0.0, 0.0, 0.0, float(31 - (1 << bit)))]
    assert column.of(rows, RUN) == [1.0, 0.0]
    (unknown,) = column.of([(0.0, 0.0, 0.0, float("nan"))], RUN)
    assert unknown != unknown
