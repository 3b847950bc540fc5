"""A robot on two wheels."""

from tuisim.engine.shim.pybricks.robotics import DriveBase as DriveBase
