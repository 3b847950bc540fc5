"""The driver of one motor: what stops and holds do, and what they leave alone."""

from __future__ import annotations

from tuisim.engine.core.driver.plant import STEP_NS
from tuisim.engine.core.driver.regulator import MODELS, MotorDriver, StopAction


def build_driver(kind: str = "large") -> MotorDriver:
    return MotorDriver(MODELS[kind], MODELS[kind].plant, 8.0)


def run(driver: MotorDriver, begin_ms: int, end_ms: int) -> None:
    for step in range(begin_ms // 2, end_ms // 2):
        driver.control((step + 1) * STEP_NS)


def holds(driver: MotorDriver) -> bool:
    return driver._control is driver.hold_control


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


def test_a_move_at_speed_0_ends_only_if_it_is_at_its_target() -> None:
    driver = build_driver()
    driver.run_to(0, 0, StopAction.BRAKE)
    run(driver, 0, 2)
    assert not driver.is_running
    driver.run_to(5, 0, StopAction.BRAKE)
    run(driver, 2, 1000)
    assert driver.is_running


def test_setting_the_position_of_a_held_motor_does_not_move_it() -> None:
    driver = build_driver()
    driver.halt(0, StopAction.HOLD)
    driver.set_position(1000)
    run(driver, 0, 100)
    assert driver.position == 1000 and driver.axle.speed_dps == 0.0
