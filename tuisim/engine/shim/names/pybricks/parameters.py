"""Enumerations of ports, colours, buttons and directions."""

from tuisim.engine.shim.pybricks.font import Font as Font
from tuisim.engine.shim.pybricks.image import Image as Image
from tuisim.engine.shim.pybricks.matrix import Axis as Axis
from tuisim.engine.shim.pybricks.matrix import Side as Side
from tuisim.engine.shim.pybricks.media import ImageFile as ImageFile
from tuisim.engine.shim.pybricks.media import SoundFile as SoundFile
from tuisim.engine.shim.pybricks.parameters import (
    Align as Align,
)
from tuisim.engine.shim.pybricks.parameters import (
    Button as Button,
)
from tuisim.engine.shim.pybricks.parameters import (
    Color as Color,
)
from tuisim.engine.shim.pybricks.parameters import (
    Direction as Direction,
)
from tuisim.engine.shim.pybricks.parameters import (
    Port as Port,
)
from tuisim.engine.shim.pybricks.parameters import (
    Stop as Stop,
)
