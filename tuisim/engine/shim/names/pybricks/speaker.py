"""The speaker, as version 1.0 has it."""

from tuisim.engine.shim.pybricks.media import SoundFile as SoundFile
from tuisim.engine.shim.pybricks.speaker import Speaker as Ev3devSpeaker  # noqa: F401 - it is seen
from tuisim.engine.shim.pybricks.tools import wait as wait
from tuisim.engine.shim.pybricks.version_1 import Speaker as Speaker
