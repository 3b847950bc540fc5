"""Images, fonts and files of the brick."""

from tuisim.shim.pybricks.font import Font as Font
from tuisim.shim.pybricks.image import Image as Image
from tuisim.shim.pybricks.media import ImageFile as ImageFile
from tuisim.shim.pybricks.media import SoundFile as SoundFile
