"""Motors and sensors of the EV3."""

from tuisim.engine.shim.pybricks.ev3devices import (
    ColorSensor,
    GyroSensor,
    InfraredSensor,
    TouchSensor,
    UltrasonicSensor,
)
from tuisim.engine.shim.pybricks.motor import Motor as CompatMotor
from tuisim.engine.shim.pybricks.parameters import Stop
from tuisim.engine.shim.pybricks.wrappers import Motor
