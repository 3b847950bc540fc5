"""Students who miss something, each in another manner."""

from __future__ import annotations

from tests.tasks.marks.right import HOPS, MAGIC
from tests.tasks.marks.student import ARRIVAL, EVERY, Student, single

_FIRST_THREE = (
    MAGIC
    + """\
for band in range(1, 4):
    tank_drive.on_for_rotations(50, 50, (170 if band == 1 else 400) / 175.929)
    print("Colour:", colorLeft.reflected_light_intensity_pc)
tank_drive.on_for_rotations(50, 50, 630 / 175.929)
"""
)

_SKIPS_GREY = (
    MAGIC
    + """\
for mm in (170, 400, 800):
    tank_drive.on_for_rotations(50, 50, mm / 175.929)
    print("Colour:", colorLeft.reflected_light_intensity_pc)
tank_drive.on_for_rotations(50, 50, 230 / 175.929)
"""
)

_TOUCHES = (
    HOPS
    + """\
tank_drive.on_for_rotations(50, 50, 170 / 175.929)
tank_drive.on_for_rotations(-50, -50, 170 / 175.929)
"""
)

_TURNS = HOPS + "tank_turn.on_for_degrees(100, 20, 32)\n"

_CURVE = (
    MAGIC
    + """\
for mm in (170, 400, 400, 400):
    tank_drive.on_for_rotations(50, 50, mm / 175.929)
    print("Colour:", colorLeft.reflected_light_intensity_pc)
tank_drive.on_for_rotations(50, 45, 230 / 175.929)
"""
)

_STOPS_AT_BLACK = (
    MAGIC
    + """\
tank_drive.on(50, 50)
while colorLeft.reflected_light_intensity_pc > 1:
    print("Colour:", colorLeft.reflected_light_intensity_pc)
tank_drive.off()
print("Colour:", colorLeft.reflected_light_intensity_pc)
"""
)

_NEVER_STOPS = (
    MAGIC
    + """\
tank_drive.on(50, 50)
while True:
    print("Colour:", colorLeft.reflected_light_intensity_pc)
"""
)

_CRASHES_LAST = (
    HOPS
    + """\
levels = []
print("mean:", sum(levels) / len(levels))
"""
)

_COUNTS_WHITE = (
    MAGIC
    + """\
bands = 0
tank_drive.on(30, 30)
before = 100
while bands < 3:
    level = colorLeft.reflected_light_intensity_pc
    print("Colour:", level)
    if before < 99 <= level:
        bands += 1
    before = level
tank_drive.off()
tank_drive.on_for_rotations(30, 30, 120 / 175.929)
"""
)

NEAR_MISSES = (
    single(
        "yann",
        HOPS.replace("intensity_pc", "intensity"),
        "logs 220, 211, 128, 0 instead of percent",
        ("levels",),
    ),
    single(
        "zora",
        HOPS.replace("colorLeft", "int(colorLeft").replace("_pc)", "_pc))"),
        "cuts 82.7 down to 82, which is 0.7 off",
        ("levels",),
    ),
    single(
        "anton", HOPS.replace("Colour:", "Color:"), "logs a variable of another name", ("levels",)
    ),
    single(
        "bella",
        HOPS.replace('"Colour:", ', ""),
        "prints numbers without a name: no samples",
        ("levels",),
    ),
    single("carlo", _FIRST_THREE, "counts to 3: black is missing", ("levels",)),
    single("dina", _SKIPS_GREY, "leaves out the third band", ("levels",)),
    single(
        "edgar",
        HOPS.replace("(170, ", "(150 - 100, "),
        "begins 120 mm short: reads white at x 200, 600, 1000 and 1400, and ends at x 1630",
        EVERY,
    ),
    single(
        "gustav",
        HOPS.replace("230 /", "275 /"),
        "stops 45 mm late, more than 30, less than 100",
        ("place",),
    ),
    single(
        "ines",
        HOPS.replace("175.929", "176.8"),
        "rounds the rotation to 176.8 mm: 0.5 % of 1600 is 8 mm short, within 30",
    ),
    single(
        "jonas",
        HOPS.replace("230 /", "630 /"),
        "does not stop at the place: x 2150, through the wall, which is not solid",
        ARRIVAL,
    ),
    single(
        "kira",
        _TOUCHES,
        "drives on to x 1920, where its front touches the wall, and comes back",
        ("wall",),
    ),
    single(
        "lars",
        _TURNS,
        "turns at the end: 32° of the wheel are 15.6 mm at 90 mm, 10° to the right",
        ("heading",),
    ),
    single(
        "mona",
        _CURVE,
        "the right wheel drives 207 mm while the left drives 230: 23 / 180 rad are 7° to the right; ends about "
        "11 mm short and 14 mm aside, within 30",
        ("heading",),
    ),
    single(
        "nils",
        HOPS.replace("50, 50", "15, 15"),
        "at speed 15, 77 mm/s: 1600 mm take more than 20 s",
        ("done",),
    ),
    single(
        "olga",
        HOPS + "import time\ntime.sleep(15)\n",
        "arrives in time, but ends after more than 20 s",
        ("done",),
    ),
    single(
        "pavel", _STOPS_AT_BLACK, "logs all four levels and stops on the last band, x 1430", ARRIVAL
    ),
    single(
        "rita",
        _NEVER_STOPS,
        "never stops: passes the place and the wall until the limit",
        ARRIVAL,
        line=4,
    ),
    single("stefan", _CRASHES_LAST, "does all, then divides by zero in line 7", ("done",), line=7),
    single("uwe", _COUNTS_WHITE, "off by one: stops behind the third band", EVERY),
    Student(
        "vera",
        {"main.py": "from helper import go\n\ngo()\n", "helpers.py": "def go():\n    pass\n"},
        EVERY,
        "imports a module of another name than its own: ModuleNotFoundError in line 1",
        line=1,
    ),
)
