"""A profile of the tests: the brick's library as it is, and motors whose moves end exactly where they must."""

from __future__ import annotations

from dataclasses import replace

from tuisim.engine.core.profile import EV3, MS, MotorLaw

EXACT = replace(
    EV3,
    name="exact",
    motor_law=MotorLaw.BRICK,
    color_read_ns=10 * MS,
    color_code_read_ns=10 * MS,
    ultrasonic_read_ns=10 * MS,
    gyro_read_ns=10 * MS,
    attribute_read_ns=1 * MS,
    attribute_write_ns=0,
    cached_read_ns=0,
)
