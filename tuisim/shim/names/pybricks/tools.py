"""Waits, stop watch and log; tasks, as version 4 has them."""

from tuisim.shim.pybricks.tools import DataLog as DataLog
from tuisim.shim.pybricks.tools import StopWatch as StopWatch
from tuisim.shim.pybricks.tools import wait as wait
from tuisim.shim.pybricks.version_4 import multitask as multitask
from tuisim.shim.pybricks.version_4 import run_task as run_task
