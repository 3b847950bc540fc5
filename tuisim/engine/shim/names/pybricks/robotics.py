"""A robot on two wheels."""

from tuisim.engine.shim.pybricks.parameters import Stop as Stop
from tuisim.engine.shim.pybricks.robotics import DriveBase as CompatDriveBase  # noqa: F401 - it is seen
from tuisim.engine.shim.pybricks.tools import wait as wait
from tuisim.engine.shim.pybricks.wrappers import DriveBase as DriveBase
