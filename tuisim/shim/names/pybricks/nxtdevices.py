"""Motors of the NXT."""

from tuisim.shim.pybricks.motor import Motor as Motor
