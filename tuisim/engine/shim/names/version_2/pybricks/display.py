"""The screen, as version 1.0 has it."""

from tuisim.engine.shim.pybricks.media import ImageFile
from tuisim.engine.shim.pybricks.parameters import Align
from tuisim.engine.shim.pybricks.version_1 import Display
