"""A program to run, its prelude, and its text as Python reads it: from bytes, and line by line."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError

_IMPORTS = """\
from ev3dev2.motor import MoveTank, MoveSteering, SpeedPercent, OUTPUT_B, OUTPUT_C
from ev3dev2.sensor import INPUT_1, INPUT_2, INPUT_3, INPUT_4
from ev3dev2.sensor.lego import ColorSensor, GyroSensor, UltrasonicSensor
from ev3dev2.sound import Sound
from ev3dev2_glue import get_clock
"""

_INSTANCES = """\
tank_turn = MoveSteering(OUTPUT_B, OUTPUT_C)
tank_drive = MoveTank(OUTPUT_B, OUTPUT_C)
ultrasonic = UltrasonicSensor(INPUT_1)
colorLeft = ColorSensor(INPUT_2)
colorRight = ColorSensor(INPUT_3)
gyro = GyroSensor(INPUT_4)


def say(txt, wait=False, show=True):
    \"\"\"Print a text and speak it; wait=True lets the program wait until it is said.\"\"\"
    if show:
        print(txt)
    Sound().speak(str(txt).replace("'", "\\u2019"), play_type=0 if wait else 1)
"""

PRELUDE_TEXTS: Mapping[str, str] = {
    "none": "",
    "imports": _IMPORTS,
    "preloaded": _IMPORTS + _INSTANCES,
}
"""The text of each prelude, by name: it runs before a program and defines names for it."""

PYBRICKS = "pybricks"
LIBRARIES = ("ev3dev2", "ev3dev", PYBRICKS)
"""The packages of the libraries for a brick: a program that imports one needs no prelude."""
SPIKE_MODULES: Mapping[str, str] = {
    "color_sensor": "ColorSensor(Port.A).color() of pybricks.pupdevices",
    "distance_sensor": "UltrasonicSensor(Port.A).distance() of pybricks.pupdevices",
    "force_sensor": "ForceSensor(Port.A).pressed() of pybricks.pupdevices",
    "hub": "PrimeHub() of pybricks.hubs",
    "mindstorms": "InventorHub() of pybricks.hubs",
    "motor": "Motor(Port.A).run_angle(720, 360) of pybricks.pupdevices",
    "motor_pair": "DriveBase(left, right, 56, 112).straight(300) of pybricks.robotics",
    "runloop": "run_task(main()) and await wait(1000) of pybricks.tools",
    "spike": "PrimeHub() of pybricks.hubs",
}
"""Modules of LEGO's own Python for SPIKE and the Robot Inventor, and what Pybricks has in place of each."""
HUB_DEVICES = "pybricks.pupdevices"
"""The module of Pybricks for motors and sensors of hubs other than the EV3."""
PYBRICKS_4_NAMES = frozenset({"ThisHub", "hub_menu", "multitask", "run_task"})
"""Names that only Pybricks 4 has, and that nothing else is called."""

PRELUDES: Mapping[str, str] = {
    "sim_magic": "none",
    "sim_magic_imports": "imports",
    "sim_magic_preloaded": "preloaded",
}
"""The prelude of each magic."""
APP_MAGIC = "sim_app"
"""The magic that shows the app in its cell, beside all that the others do."""


@dataclass(frozen=True, slots=True)
class Program:
    """A program to run, or the program of a stored run."""

    name: str
    """File name as displayed to the user."""
    text: str
    """The source; a magic line is commented out, which keeps the file's line numbers."""
    prelude: str = "none"
    """none, imports or preloaded."""
    path: str = ""
    """Path of its file; empty if it is in no file."""
    arguments: tuple[str, ...] = ()
    """Contents of `sys.argv` after the path."""
    python_path: tuple[str, ...] = ()
    """Folders besides its own in which it searches modules: the user's PYTHONPATH."""
    working_directory: str = ""
    """Initial working directory; empty means the current one, with the PYTHONPATH of this process."""
    module_folder: str = ""
    """Module folder of a program without a file, such as the folder of the notebook whose cell it is."""
    shown_ports: tuple[str, ...] | None = None
    """The ports of the parts that its text shows, such as `in1`: what it asks for elsewhere is plugged in. None: the
    robot stays as it is."""
    modules_from: Path | None = None
    """Folder of an earlier run: modules are read as that one recorded them; None reads them from their files."""

    @property
    def file(self) -> str:
        """The file name in the program's tracebacks: its path, or its name if it is not in a file."""
        return self.path or self.name

    def add_surroundings(self) -> Program:
        """Return a program that has a working directory; a program that has one already is returned unchanged.

        Any other program gets the working directory of this process, and the folders in the user's PYTHONPATH.
        """
        if self.working_directory:
            return self
        try:
            here = os.getcwd()
        except FileNotFoundError:
            # The working directory has been deleted.
            here = ""
        return replace(self, python_path=user_python_path(), working_directory=here)

    @property
    def sha256(self) -> str:
        """The hash of the program's text in UTF-8, hexadecimal."""
        # Imported here: the child process that runs a program does not need it.
        import hashlib

        return hashlib.sha256(self.text.encode("utf-8", "surrogatepass")).hexdigest()


_DOMAIN_ENCODINGS = frozenset({"idna", "punycode"})
"""Encodings in which no program is written: decoding punycode takes hours for the largest program that is read."""


def find_code_line(lines: Sequence[str], line: int) -> int:
    """Return the number of the first line with code from `line` on, both from 1; 0 if there is none.

    Blank lines, comments and magics are not code.
    """
    rest = enumerate(lines[line - 1 :], line)
    return next(
        (
            number
            for number, text in rest
            if text.strip() and not text.lstrip().startswith(("#", "%"))
        ),
        0,
    )


def source_lines(text: str) -> list[str]:
    """Return the lines of a program, without line endings, numbered as Python numbers them.

    `str.splitlines` also splits at form feed, U+2028 and others; line numbers would then differ from those in
    tracebacks and breakpoints.
    """
    lines = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    # After a final line ending there is no further line.
    return lines if lines[-1] else lines[:-1]


def find_encoding(data: bytes) -> str:
    """Return the encoding of a program file, as Python names it.

    Raises:
        SyntaxError, LookupError: there is no such encoding, or it is one for domain names, such as `idna`.
    """
    # Imported here: the child process that runs a program does not need them.
    import codecs
    import io
    import tokenize

    encoding, _ = tokenize.detect_encoding(io.BytesIO(data).readline)
    if codecs.lookup(encoding).name in _DOMAIN_ENCODINGS:
        raise LookupError(f"{encoding!r} is an encoding of domain names")
    return encoding


def decode_source(data: bytes, shown: str) -> tuple[str, str]:
    """Return the text of a program file, and its encoding as Python names it.

    Args:
        data: The bytes of the file.
        shown: The name of the file in errors.

    Raises:
        ConfigError: it is not text, or its encoding is not a text encoding.
    """
    try:
        encoding = find_encoding(data)
        return data.decode(encoding), encoding
    # The encoding may be one such as `rot13`, which is not for text, or `undefined`, which always raises.
    except (SyntaxError, LookupError, ValueError) as error:
        raise ConfigError(f"is not Python text: {error}", "save it as UTF-8", file=shown) from None


def user_python_path() -> tuple[str, ...]:
    """Return the folders in the user's PYTHONPATH; an empty entry is the current folder, as in Python."""
    folders = os.environ.get("PYTHONPATH")
    return tuple(os.path.abspath(folder) for folder in folders.split(os.pathsep)) if folders else ()
