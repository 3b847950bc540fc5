"""The two controllers of the driver, in whole numbers as in C."""

from __future__ import annotations

MAX_DUTY = 100
SCALE = 10_000
"""The constants of a controller are ten-thousandths of a percent."""
SPEED_CONSTANTS = (1000, 60, 0)
"""Proportional, integral and derivative constant of the speed control."""
FULL = (MAX_DUTY + 1) * SCALE
"""From this result on, a controller demands more than the full duty."""
_WORD = 1 << 32


def _wrap(number: int) -> int:
    """Return an integer wrapped to a signed integer of 32 bits, as in C."""
    return (number + _WORD // 2) % _WORD - _WORD // 2


def divide(dividend: int, divisor: int) -> int:
    """Return a quotient, rounded towards zero as in C."""
    quotient = abs(dividend) // divisor
    return quotient if dividend >= 0 else -quotient


class Controller:
    """A PID controller: it computes the power of a motor in percent, its duty.

    The duty follows from the difference between the position or speed to reach, the setpoint, and the measured one.

    Args:
        constants: Proportional, integral and derivative constant; `reset` restores them.
    """

    __slots__ = ("_constants", "error", "kd", "ki", "kp", "overloaded", "setpoint", "total")

    def __init__(self, constants: tuple[int, int, int]) -> None:
        self._constants = constants
        self.setpoint = 0
        self.reset()

    def reset(self) -> None:
        """Set the constants to their initial values, and the errors to 0."""
        self.kp, self.ki, self.kd = self._constants
        self.clear()

    def clear(self) -> None:
        """Set the controller's error of the last step and the sum of all its errors to 0."""
        self.error = self.total = 0
        """The error of the last step, and the sum of all."""
        self.overloaded = False
        """Whether the last step demanded more than the full duty."""

    def compute_duty(self, value: int) -> int:
        """Return the duty of the next step, in percent; `value` is the measured position or speed."""
        error = self.setpoint - value
        total = self.total + error
        scaled = error * self.kp + total * self.ki
        if self.kd:
            scaled += (self.error - error) * self.kd
        self.error = error
        self.overloaded = False
        if not -FULL < scaled < FULL:
            scaled = _wrap(scaled)
            if not -FULL < scaled < FULL:
                self.overloaded = True
                return MAX_DUTY if scaled > 0 else -MAX_DUTY
        self.total = total
        return scaled // SCALE if scaled > 0 else -(-scaled // SCALE)

    def is_steady(self, value: int, duty: int) -> bool:
        """Return whether the controller repeats this duty in every step, as long as `value` stays the same."""
        error = self.error
        if error != self.setpoint - value:
            return False
        if self.overloaded:
            return not self.kd
        return (
            not (self.ki and error)
            and divide(error * self.kp + self.total * self.ki, SCALE) == duty
        )
