"""Generic devices on the ports."""

from tuisim.engine.shim.pybricks.iodevices import Ev3devSensor
from tuisim.engine.shim.pybricks.motor import DCMotor
