"""A motor that nothing controls: in closed form what it is in single steps, whenever one looks."""

from __future__ import annotations

import random
from unittest.mock import patch

import pytest

from tests.cases import for_each
from tests.engine.core.driver.lab import MS, give
from tuisim.engine.core.driver import regulator
from tuisim.engine.core.driver.jiffies import Jiffies
from tuisim.engine.core.driver.motor import Command, DriverMotor
from tuisim.engine.core.driver.plant import STEP_NS
from tuisim.engine.core.driver.regulator import MODELS, StopAction

ROLLS = ("coast", "brake", "direct")


def build_rolling(seed: int, kind: str) -> tuple[DriverMotor, random.Random]:
    """Return a motor that rolls from 400 ms on: by a stop action, or by a duty."""
    chance = random.Random(seed)
    model = MODELS["large" if seed % 3 else "medium"]
    motor = DriverMotor(model, model.plant.add_load(0.00038, 0.006), 8.0, Jiffies(seed, 1370))
    speed_dps = chance.choice((-1, 1)) * chance.randrange(60, 900)
    give(motor, 0, Command.RUN_FOREVER, speed_dps=speed_dps)
    begin_ns = 400 * MS + chance.randrange(2 * MS)
    if kind == "direct":
        duty = chance.randrange(-100, 101)
        give(motor, begin_ns, Command.RUN_DIRECT, duty=duty)
    else:
        give(motor, begin_ns, Command.STOP, stop_action=StopAction(kind))
    return motor, chance


def step_on(motor: DriverMotor, time_ns: int) -> None:
    """Run a motor in single steps."""
    with patch.object(regulator, "begin_roll", lambda *_: None):
        motor.run_until(time_ns)


@for_each(kind=ROLLS, seed=range(20))
def test_a_coasting_motor_computed_at_once_equals_single_steps(seed: int, kind: str) -> None:
    rolling, chance = build_rolling(seed, kind)
    stepped, _ = build_rolling(seed, kind)
    now_ns, times_ns = 402 * MS, []
    while now_ns < 1500 * MS:
        now_ns += chance.choice((1, 40)) * chance.randrange(1, 3 * MS)
        times_ns.append(now_ns)
    for time_ns in times_ns:
        rolling.run_until(time_ns)
        step_on(stepped, time_ns)
        assert rolling.axle.angle_deg == pytest.approx(stepped.axle.angle_deg, abs=1e-9)
        assert rolling.axle.speed_dps == pytest.approx(stepped.axle.speed_dps, abs=1e-9)
        assert rolling.position == stepped.position
        assert abs(rolling.speed_dps - stepped.speed_dps) <= 1
        assert rolling.state_bits == stepped.state_bits


@for_each(kind=ROLLS, seed=range(20))
def test_a_motor_stepped_on_after_coasting_reads_the_right_speed(seed: int, kind: str) -> None:
    rolling, chance = build_rolling(seed, kind)
    stepped, _ = build_rolling(seed, kind)
    now_ns = (402 + chance.randrange(300)) * MS
    rolling.run_until(now_ns)
    step_on(stepped, now_ns)
    rolling.leave_roll()
    for time_ns in range(now_ns, now_ns + 60 * MS, MS):
        step_on(rolling, time_ns)
        step_on(stepped, time_ns)
        assert abs(rolling.speed_dps - stepped.speed_dps) <= 1


def test_a_coasting_motor_is_computed_without_single_steps() -> None:
    rolling, _ = build_rolling(4, "coast")
    steps: list[int] = []
    with patch.object(DriverMotor, "control", lambda _, time_ns: steps.append(time_ns)):
        rolling.run_until(404 * MS)
        roll = rolling._roll
        assert roll is not None and roll.end_ns > 450 * MS
        rolling.run_until(roll.end_ns)
        assert steps == [] and rolling._roll is roll
        rolling.run_until(roll.end_ns + STEP_NS)
    assert steps == [roll.end_ns + STEP_NS] and rolling._roll is None
