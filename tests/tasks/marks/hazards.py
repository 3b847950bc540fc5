"""Students whose programs could harm the marking of the others."""

from __future__ import annotations

from tests.tasks.marks.right import HOPS, MAGIC
from tests.tasks.marks.student import ARRIVAL, EVERY, Student, single

_LEVELS = (
    MAGIC
    + """\
for mm in (170, 400, 400, 400):
    tank_drive.on_for_rotations(50, 50, mm / 175.929)
    print("Colour:", colorLeft.reflected_light_intensity_pc)
"""
)
"""The levels, up to the middle of the last band, x 1520: 4 points, and none for the arrival."""

_TWO_BANDS = (
    MAGIC
    + """\
for mm in (170, 400):
    tank_drive.on_for_rotations(50, 50, mm / 175.929)
    print("Colour:", colorLeft.reflected_light_intensity_pc)
"""
)
"""Two levels, up to x 720: no points."""

_THREAD = (
    HOPS
    + """\
import threading
import time


def wait():
    while True:
        time.sleep(1)


threading.Thread(target=wait).start()
"""
)

_DELETES = (
    MAGIC
    + """\
import os
import shutil

from helpers import LAST

here = os.path.dirname(os.path.abspath(__file__))
for name in os.listdir(here):
    path = os.path.join(here, name)
    shutil.rmtree(path) if os.path.isdir(path) else os.remove(path)
for mm in (170, 400, 400, 400):
    tank_drive.on_for_rotations(50, 50, mm / 175.929)
    print("Colour:", colorLeft.reflected_light_intensity_pc)
tank_drive.on_for_rotations(50, 50, LAST / 175.929)
"""
)

EVIL = "\x1b[2J\x1b]0;owned\x07<script>alert(1)</script><img src=x onerror=alert(2)>"
"""What a student's error says: control sequences of a terminal, and HTML with scripts."""

_NAMED = (
    MAGIC
    + """\
from größe import LETZTE_MM

for mm in (170, 400, 400, 400):
    tank_drive.on_for_rotations(50, 50, mm / 175.929)
    print("Colour:", colorLeft.reflected_light_intensity_pc)
tank_drive.on_for_rotations(50, 50, LETZTE_MM / 175.929)
"""
)
ODD_NAME = 'Zoë & <b>Max\x1b[31m "Ü" 🐍'

HAZARDS = (
    single(
        "endless",
        _LEVELS + "while True:\n    pass\n",
        "hangs on the last band: keeps its levels",
        ARRIVAL,
    ),
    single(
        "flood",
        MAGIC + "while True:\n    print('x' * 1000)\n",
        "floods before it moves",
        EVERY,
        line=3,
    ),
    single(
        "stuck_in_c",
        _TWO_BANDS + "sum(range(10**15))\n",
        "hangs inside a C function on the second band; no Python line is run that could be stopped",
        EVERY,
        line=5,
    ),
    single("raises", _TWO_BANDS + "1 / 0\n", "raises on the second band", EVERY, line=5),
    single(
        "syntax", HOPS.replace("):\n", ")\n"), "does not compile: no colon in line 2", EVERY, line=2
    ),
    single(
        "sys_exit",
        _TWO_BANDS + "import sys\nsys.exit()\n",
        "ends on the second band, without an error",
        EVERY,
    ),
    single(
        "os_exit",
        _LEVELS + "import os\nos._exit(0)\n",
        "ends the process on the last band",
        ARRIVAL,
    ),
    single(
        "hog",
        _TWO_BANDS + "blocks = []\nwhile True:\n    blocks.append(bytearray(1 << 26))\n",
        "uses up the memory it may have in line 7",
        EVERY,
        line=7,
    ),
    single(
        "fork",
        _TWO_BANDS + "import os\nwhile True:\n    os.fork()\n",
        "may not fork: line 7",
        EVERY,
        line=7,
    ),
    single(
        "thread",
        _THREAD,
        "arrives, but a thread never ends: the run goes on to its limit",
        ("done",),
    ),
    single(
        "asks",
        MAGIC + "mm = int(input('how far? '))\n",
        "nobody answers: EOFError in line 2",
        EVERY,
        line=2,
    ),
    Student(
        "deletes",
        {"main.py": _DELETES, "helpers.py": "LAST = 230\n"},
        (),
        "deletes its folder and drives on: right with every seed, because each run has its own copy",
    ),
    single(
        "prints_html",
        _LEVELS + f"raise ValueError({EVIL!r})\n",
        "logs all levels, then raises",
        ARRIVAL,
        line=5,
    ),
    Student(
        ODD_NAME,
        {"main.py": _NAMED, "größe.py": "LETZTE_MM = 230\n"},
        (),
        "right, under an odd name",
    ),
    single("empty", "", "an empty file does nothing", EVERY),
    single(
        "zip",
        b"PK\x03\x04\x14\x00\x00\x00\xff\xfe\x00\x00",
        "not a Python file, although named so",
        EVERY,
    ),
)
