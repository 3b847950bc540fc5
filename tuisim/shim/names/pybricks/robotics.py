"""A robot on two wheels."""

from tuisim.shim.pybricks.robotics import DriveBase as DriveBase
