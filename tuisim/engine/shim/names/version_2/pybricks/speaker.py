"""The speaker, as version 1.0 has it."""

from tuisim.engine.shim.pybricks.media import SoundFile
from tuisim.engine.shim.pybricks.speaker import Speaker as Ev3devSpeaker
from tuisim.engine.shim.pybricks.tools import wait
from tuisim.engine.shim.pybricks.version_1 import Speaker
