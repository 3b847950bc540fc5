"""Enumerations, colours and icons."""

from tuisim.engine.shim.pybricks.hsv_color import Color
from tuisim.engine.shim.pybricks.hub.display import Icon
from tuisim.engine.shim.pybricks.hub.parameters import Button, Port
from tuisim.engine.shim.pybricks.matrix import Axis, Side
from tuisim.engine.shim.pybricks.parameters import Direction
from tuisim.engine.shim.pybricks.version_4 import Stop
