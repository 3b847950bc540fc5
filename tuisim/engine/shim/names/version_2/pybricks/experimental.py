"""Functions at the same time, as version 1.0 has them."""

from tuisim.engine.shim.pybricks.experimental import run_parallel
