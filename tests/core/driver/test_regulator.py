"""The driver of one motor: what stops and holds do, and what they leave alone."""

from __future__ import annotations

import pytest

from tuisim.core.driver.plant import STEP_NS
from tuisim.core.driver.regulator import MODELS, MotorDriver, StopAction


def build_driver(kind: str = "large") -> MotorDriver:
    return MotorDriver(MODELS[kind], MODELS[kind].plant, 8.0)


def run(driver: MotorDriver, begin_ms: int, end_ms: int) -> None:
    for step in range(begin_ms // 2, end_ms // 2):
        driver.control((step + 1) * STEP_NS)


def holds(driver: MotorDriver) -> bool:
    return driver._control is driver.hold_control


@pytest.mark.parametrize("kind", MODELS)
def test_a_hold_is_a_spring(kind: str) -> None:
    driver = build_driver(kind)
    driver.halt(0, StopAction.HOLD)
    driver.axle.angle_deg += 5
    run(driver, 0, 1000)
    assert holds(driver) and abs(driver.position) <= 1


def test_a_hold_after_a_coast_begins_when_the_wheel_is_turned() -> None:
    driver = build_driver()
    driver.run_regulated(500)
    run(driver, 0, 300)
    driver.halt(300 * STEP_NS // 2, StopAction.COAST)
    driver.axle.speed_dps = 0.0
    run(driver, 300, 800)
    driver.halt(800 * STEP_NS // 2, StopAction.HOLD)
    run(driver, 800, 1000)
    # The duty is 0 as before: the bridge still lets the motor coast.
    assert driver.axle.circuit.dps_per_percent == 0.0


def test_a_motor_that_is_to_turn_at_speed_0_is_stalled() -> None:
    driver = build_driver()
    driver.run_regulated(0)
    run(driver, 0, 102)
    assert (driver.is_running, driver.is_stalled) == (True, False)
    run(driver, 102, 104)
    assert (driver.is_stalled, driver.duty) == (True, 0)


@pytest.mark.parametrize("target", [90, -90])
def test_a_move_arrives_and_holds_its_target(target: int) -> None:
    driver = build_driver()
    driver.run_to(target, 300, StopAction.HOLD)
    run(driver, 0, 2000)
    assert holds(driver) and driver.hold_control.setpoint == target
    assert abs(driver.position - target) <= 1


def test_a_move_at_speed_0_arrives_only_where_it_is() -> None:
    driver = build_driver()
    driver.run_to(0, 0, StopAction.BRAKE)
    run(driver, 0, 2)
    assert not driver.is_running
    driver.run_to(5, 0, StopAction.BRAKE)
    run(driver, 2, 1000)
    assert driver.is_running


def test_another_number_for_the_position_moves_a_hold_along() -> None:
    driver = build_driver()
    driver.halt(0, StopAction.HOLD)
    driver.renumber(1000)
    run(driver, 0, 100)
    assert driver.position == 1000 and driver.axle.speed_dps == 0.0
