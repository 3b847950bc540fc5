"""The controllers of the driver."""

from __future__ import annotations

from tuisim.engine.core.driver.control import SPEED_CONSTANTS, Controller, divide


def test_the_motor_controller_divides_towards_zero_as_c_does() -> None:
    assert [divide(number, 2) for number in (-3, -1, 0, 1, 3)] == [-1, 0, 0, 0, 1]


def test_the_duty_has_a_proportional_and_an_integral_part() -> None:
    control = Controller(SPEED_CONSTANTS)
    control.setpoint = 200
    # 0.1 % per deg/s, and 0.006 % more for each deg/s and step.
    assert [control.compute_duty(0) for _ in range(4)] == [21, 22, 23, 24]
    assert control.compute_duty(200) == 4


def test_an_overloaded_motor_controller_does_not_integrate_the_error() -> None:
    control = Controller(SPEED_CONSTANTS)
    control.setpoint = -2000
    assert [control.compute_duty(0) for _ in range(3)] == [-100] * 3
    assert control.overloaded
    assert control.compute_duty(-2000) == 0
    assert not control.overloaded


def test_numbers_of_the_motor_controller_overflow_at_32_bits() -> None:
    control = Controller((80_000, 0, 0))
    control.setpoint = 26_844
    assert control.compute_duty(0) == -100


def test_the_derivative_part_of_the_duty_has_the_opposite_sign() -> None:
    control = Controller((0, 0, 10_000))
    control.setpoint = 10
    assert [control.compute_duty(0), control.compute_duty(0), control.compute_duty(5)] == [
        -10,
        0,
        5,
    ]


def test_reset_restores_the_constants_of_a_motor_controller() -> None:
    control = Controller(SPEED_CONSTANTS)
    control.ki = 0
    control.setpoint = 200
    control.reset()
    assert control.ki == 60
