"""Images, fonts and files of the brick."""

from tuisim.engine.shim.pybricks.font import Font
from tuisim.engine.shim.pybricks.image import Image
from tuisim.engine.shim.pybricks.media import ImageFile, SoundFile
