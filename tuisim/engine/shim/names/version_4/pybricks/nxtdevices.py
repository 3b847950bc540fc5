"""Motors of the NXT."""

from tuisim.engine.shim.pybricks.motor import Motor
