"""The simulator and its log, as the first cell of a course's notebook imports them."""

from tuisim.notebook import eds, roboSim

__all__ = ["eds", "roboSim"]
