"""Motors and sensors of the EV3."""

from tuisim.engine.shim.pybricks.ev3devices import TouchSensor, UltrasonicSensor
from tuisim.engine.shim.pybricks.version_4 import ColorSensor, GyroSensor, InfraredSensor, Motor
