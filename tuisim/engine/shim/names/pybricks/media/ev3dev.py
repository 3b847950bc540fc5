"""Images, fonts and files of the brick."""

from tuisim.engine.shim.pybricks.font import Font as Font
from tuisim.engine.shim.pybricks.image import Image as Image
from tuisim.engine.shim.pybricks.media import ImageFile as ImageFile
from tuisim.engine.shim.pybricks.media import SoundFile as SoundFile
