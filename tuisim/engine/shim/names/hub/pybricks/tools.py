"""Waits, a stopwatch, matrices, tasks and a menu."""

from tuisim.engine.shim.names.version_4.pybricks.tools import *  # noqa: F403 - and what only hubs have
from tuisim.engine.shim.pybricks.hub.display import hub_menu
