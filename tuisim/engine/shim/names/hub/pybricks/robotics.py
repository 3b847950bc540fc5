"""A robot on two wheels."""

from tuisim.engine.shim.pybricks.version_4 import DriveBase, GyroDriveBase
