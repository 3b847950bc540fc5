"""Waits, a stopwatch and a log."""

from builtins import print

from tuisim.engine.shim.pybricks.tools import DataLog, StopWatch, localtime, ticks_us, wait
