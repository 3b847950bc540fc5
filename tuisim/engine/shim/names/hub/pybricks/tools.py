"""Waits, a stopwatch, matrices, tasks and a menu."""

from tuisim.engine.shim.pybricks.hub.display import hub_menu
from tuisim.engine.shim.pybricks.matrix import Axis, Matrix, cross, vector
from tuisim.engine.shim.pybricks.tools import wait
from tuisim.engine.shim.pybricks.version_4 import StopWatch, multitask, read_input_byte, run_task
