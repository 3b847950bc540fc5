"""Generic devices on the ports."""

from tuisim.shim.pybricks.iodevices import Ev3devSensor as Ev3devSensor
from tuisim.shim.pybricks.motor import DCMotor as DCMotor
