"""Honest programs as students write and gradebooks deliver them: each must get all that the plain one gets."""

from __future__ import annotations

import os
import socket
import stat
import zipfile
from collections.abc import Callable, Mapping
from contextlib import chdir, closing
from pathlib import Path
from random import Random

IDIOMS = (
    "print('Grey:', colorLeft.reflected_light_intensity_pc)",
    "value = colorLeft.reflected_light_intensity_pc\nprint(f'Grey: {value:.1f}')",
    "def show(*args):\n    print(*args)\nshow('Grey:', colorLeft.reflected_light_intensity_pc)",
    "import sys\ndef debug_print(*args, **kwargs):\n    print(*args, **kwargs)\n"
    "debug_print('Grey:', colorLeft.reflected_light_intensity_pc, end='\\n', flush=True)",
    "match colorLeft.reflected_light_intensity_pc:\n    case value:\n        print('Grey:', value)",
    "print('Grey:', getattr(colorLeft, 'reflected_light_intensity_pc'))",
    "class Robot:\n    def look(self):\n        self.value = colorLeft.reflected_light_intensity_pc\n"
    "robot = Robot()\nrobot.look()\nprint('Grey: ' + str(robot.value))",
    "values = [colorLeft.reflected_light_intensity_pc for _ in range(5)]\n"
    "print('Grey:', sum(values) / len(values))",
    "def look(): return colorLeft.reflected_light_intensity_pc\n"
    "show = lambda text, value: print(text, value)\nshow('Grey:', look())",
)
"""Ways to print what the sensor reads."""
SOUND = """\
import os, stat
for entry in os.scandir('.'):
    mode = entry.stat(follow_symlinks=False)
    assert stat.S_ISREG(mode.st_mode) or stat.S_ISDIR(mode.st_mode), entry.name
    assert mode.st_mode & stat.S_IWUSR, entry.name
    assert mode.st_blocks * 512 < 1 << 20, entry.name
    assert not entry.name.startswith('._') and entry.name not in ('venv', 'node_modules'), entry.name
assert os.stat('.').st_mode & stat.S_IWUSR
open('log.txt', 'w').close()
"""
"""Checks the program's own folder: all is writable, nothing is there that was not handed in, and no device."""


def _write(path: Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)


def _moodle_folder(random: Random, place: Path, text: str) -> None:
    folder = place.with_name(f"Eve Ä_{random.randrange(10**6)}_assignsubmission_file_")
    _write(folder / random.choice(("robot.py", "lab/robot.py")), text)
    online = folder.with_name(folder.name.replace("file", "onlinetext"))
    _write(online / "onlinetext.html", "<p>done</p>")


def _moodle_file(random: Random, place: Path, text: str) -> None:
    start = f"Eve_Lu_{random.randrange(10**6)}_assignsubmission_"
    _write(place.with_name(f"{start}file_main.py"), text)
    _write(place.with_name(f"{start}onlinetext_onlinetext.html"), "<p>done</p>")


def _canvas(random: Random, place: Path, text: str) -> None:
    user = random.randrange(10**5)
    late = random.choice(("", "_LATE"))
    _write(place.with_name(f"lueve{late}_{user}_340_robot.py"), text)
    _write(place.with_name(f"lueve_{user}_99_robot.py"), "1 / 0\n")
    if random.random() < 0.5:
        _write(place.with_name(f"lueve_{user}_340_robot-1.py"), text)
        _write(place.with_name(f"lueve{late}_{user}_340_robot.py"), "1 / 0\n")


def _mac(random: Random, place: Path, text: str) -> None:
    _write(place / "robot.py", text)
    for name in (
        "._robot.py",
        ".DS_Store",
        "__MACOSX/._robot.py",
        "venv/lib.py",
        "node_modules/a.py",
    ):
        _write(place / name, "\0\5")
    _write(place.with_name("__MACOSX") / "eve" / "._robot.py", "\0\5")


def _folders(random: Random, place: Path, text: str) -> None:
    for _ in range(random.randint(1, 3)):
        place = place / "lab"
    _write(place / "robot.py", text)
    if random.random() < 0.5:
        _write(place / "__init__.py", "")


def _zip(random: Random, place: Path, text: str) -> None:
    with zipfile.ZipFile(place.with_suffix(".zip"), "w") as archive:
        archive.writestr(f"{random.choice(('', 'lab/'))}robot.py", text)
        archive.writestr("__MACOSX/._robot.py", b"\0\5")


def _read_only(random: Random, place: Path, text: str) -> None:
    _write(place / "main.py", text)
    _write(place / "data.txt", "1")
    for path in (place / "main.py", place / "data.txt", place):
        path.chmod(0o555 if path == place else 0o444)


def _beside(random: Random, place: Path, text: str) -> None:
    _write(place / "main.py", text)
    with closing(socket.socket(socket.AF_UNIX)) as listener, chdir(place):
        listener.bind("socket")
        os.mkfifo("pipe")
        open("sparse", "w").close()
        os.truncate("sparse", 32 << 20)
        if not os.getuid():
            os.mknod("null", stat.S_IFCHR | 0o600, os.makedev(1, 3))


def _latin(random: Random, place: Path, text: str) -> None:
    place.mkdir()
    Path(os.fsdecode(os.fsencode(place) + b"/r\xf6bot.py")).write_text(text)


DELIVERIES: Mapping[str, Callable[[Random, Path, str], None]] = {
    "moodle folder": _moodle_folder,
    "moodle file": _moodle_file,
    "canvas": _canvas,
    "mac": _mac,
    "folders": _folders,
    "zip": _zip,
    "read only": _read_only,
    "beside": _beside,
    "latin": _latin,
}
"""Ways to hand in a program: functions of a generator of random numbers, the place of the student, and the text."""


def deliver(random: Random, place: Path, magic: str) -> None:
    """Hand in an honest program in some way."""
    way = random.choice(list(DELIVERIES.values()))
    way(random, place, f"# {magic}\n{SOUND}{random.choice(IDIOMS)}\n")
