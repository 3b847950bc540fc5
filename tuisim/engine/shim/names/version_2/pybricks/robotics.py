"""A robot on two wheels."""

from tuisim.engine.shim.pybricks.parameters import Stop
from tuisim.engine.shim.pybricks.robotics import DriveBase as CompatDriveBase
from tuisim.engine.shim.pybricks.tools import wait
from tuisim.engine.shim.pybricks.wrappers import DriveBase
