"""The two controllers of the driver, in whole numbers as in C."""

from __future__ import annotations

MAX_DUTY = 100
SCALE = 10_000
"""The constants of a controller are ten-thousandths of a percent."""
SPEED_CONSTANTS = (1000, 60, 0)
"""Proportional, integral and derivative constant of the speed control."""
FULL = (MAX_DUTY + 1) * SCALE
"""From here on a controller asks for more than the full duty."""
_WORD = 1 << 32


def _wrap(number: int) -> int:
    """Return a whole number as 32 bits hold it."""
    return (number + _WORD // 2) % _WORD - _WORD // 2


def divide(dividend: int, divisor: int) -> int:
    """Return a quotient, cut off as in C."""
    quotient = abs(dividend) // divisor
    return quotient if dividend >= 0 else -quotient


class Controller:
    """One controller, which makes a duty of a setpoint and a value.

    Args:
        constants: Proportional, integral and derivative constant; `reset` restores them.
    """

    __slots__ = ("_constants", "error", "kd", "ki", "kp", "overloaded", "setpoint", "total")

    def __init__(self, constants: tuple[int, int, int]) -> None:
        self._constants = constants
        self.setpoint = 0
        self.reset()

    def reset(self) -> None:
        """Restore the constants, and forget the errors."""
        self.kp, self.ki, self.kd = self._constants
        self.clear()

    def clear(self) -> None:
        """Forget the errors."""
        self.error = self.total = 0
        """Of the last step, and of all."""
        self.overloaded = False
        """Whether it asks for more than the full duty."""

    def compute_duty(self, value: int) -> int:
        """Return the duty of the next step, in percent."""
        error = self.setpoint - value
        change = self.error - error
        self.error = error
        self.total += error
        scaled = error * self.kp + self.total * self.ki + change * self.kd
        self.overloaded = False
        if not -FULL < scaled < FULL:
            scaled = _wrap(scaled)
            if not -FULL < scaled < FULL:
                self.overloaded = True
                self.total -= error
                return MAX_DUTY if scaled > 0 else -MAX_DUTY
        return scaled // SCALE if scaled > 0 else -(-scaled // SCALE)

    def is_steady(self, value: int, duty: int) -> bool:
        """Return whether a value that stays makes a duty that stays."""
        error = self.error
        if error != self.setpoint - value:
            return False
        if self.overloaded:
            return not self.kd
        return (
            not (self.ki and error)
            and divide(error * self.kp + self.total * self.ki, SCALE) == duty
        )
