"""Enumerations, colours and images."""

from tuisim.engine.shim.pybricks.font import Font
from tuisim.engine.shim.pybricks.hsv_color import Color
from tuisim.engine.shim.pybricks.image import Image
from tuisim.engine.shim.pybricks.matrix import Axis, Side
from tuisim.engine.shim.pybricks.media import ImageFile
from tuisim.engine.shim.pybricks.parameters import Button, Direction, Port
from tuisim.engine.shim.pybricks.version_4 import Stop
