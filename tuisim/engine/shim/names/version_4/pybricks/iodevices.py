"""Generic devices on the ports."""

from tuisim.engine.shim.pybricks.motor import DCMotor
