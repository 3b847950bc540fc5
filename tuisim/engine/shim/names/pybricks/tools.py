"""Waits, stop watch and log; tasks, as version 4 has them."""

from tuisim.engine.shim.pybricks.matrix import Axis as Axis
from tuisim.engine.shim.pybricks.matrix import Matrix as Matrix
from tuisim.engine.shim.pybricks.matrix import cross as cross
from tuisim.engine.shim.pybricks.matrix import vector as vector
from tuisim.engine.shim.pybricks.tools import DataLog as DataLog
from tuisim.engine.shim.pybricks.tools import StopWatch as StopWatch
from tuisim.engine.shim.pybricks.tools import localtime as localtime
from tuisim.engine.shim.pybricks.tools import ticks_us as ticks_us
from tuisim.engine.shim.pybricks.tools import wait as wait
from tuisim.engine.shim.pybricks.version_4 import multitask as multitask
from tuisim.engine.shim.pybricks.version_4 import read_input_byte as read_input_byte
from tuisim.engine.shim.pybricks.version_4 import run_task as run_task
