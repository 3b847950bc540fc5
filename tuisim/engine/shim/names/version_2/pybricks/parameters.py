"""Enumerations of ports, colours, buttons and directions."""

from tuisim.engine.shim.pybricks.media import ImageFile, SoundFile
from tuisim.engine.shim.pybricks.parameters import Align, Button, Color, Direction, Port, Stop
