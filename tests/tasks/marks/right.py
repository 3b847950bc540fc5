"""Students whose programs are right, each in another manner."""

from __future__ import annotations

from tests.tasks.marks.student import Student, single

MAGIC = "# %%sim_magic_preloaded -b Grey_bands\n"
HOPS = (
    MAGIC
    + """\
for mm in (170, 400, 400, 400):
    tank_drive.on_for_rotations(50, 50, mm / 175.929)
    print("Colour:", colorLeft.reflected_light_intensity_pc)
tank_drive.on_for_rotations(50, 50, 230 / 175.929)
"""
)
"""The plainest right program: it reads in the middle of each band, and drives on to the place."""

_POLL = (
    MAGIC
    + """\
tank_drive.on(SpeedPercent(50), SpeedPercent(50))
while colorLeft.reflected_light_intensity_pc > 1:
    print("Colour: " + str(colorLeft.reflected_light_intensity_pc))
while colorLeft.reflected_light_intensity_pc < 50:
    print("Colour: " + str(colorLeft.reflected_light_intensity_pc))
tank_drive.off()
tank_drive.on_for_rotations(50, 50, 127 / 175.929)
"""
)

_SLEEPS = (
    MAGIC
    + """\
import time
tank_drive.on(40, 40)
value = 100
while value > 1:
    time.sleep(0.1)
    value = colorRight.reflected_light_intensity_pc
    print(f"Colour: {value}")
while colorRight.reflected_light_intensity_pc < 50:
    time.sleep(0.01)
tank_drive.on_for_rotations(40, 40, 127 / 175.929)
"""
)

_IMPORTS = """\
#!/usr/bin/env python3
from ev3dev2.motor import MoveTank, OUTPUT_B, OUTPUT_C, SpeedPercent
from ev3dev2.sensor import INPUT_2
from ev3dev2.sensor.lego import ColorSensor

tank = MoveTank(OUTPUT_B, OUTPUT_C)
eye = ColorSensor(INPUT_2)
for mm in [170, 400, 400, 400]:
    tank.on_for_rotations(SpeedPercent(50), SpeedPercent(50), mm / 175.929)
    print("Colour:", eye.reflected_light_intensity_pc)
tank.on_for_rotations(SpeedPercent(50), SpeedPercent(50), 230 / 175.929)
"""

_SIM_MAGIC_IMPORTS = """\
%%sim_magic_imports -b Grey_bands
tank = MoveTank(OUTPUT_B, OUTPUT_C)
eye = ColorSensor(INPUT_3)
for mm in (170, 400, 400, 400):
    tank.on_for_rotations(50, 50, mm / 175.929)
    print("Colour:", eye.reflected_light_intensity_pc)
tank.on_for_rotations(50, 50, 230 / 175.929)
"""

_FUNCTIONS = (
    MAGIC
    + """\
def drive(mm):
    tank_drive.on_for_rotations(50, 50, mm / 175.929)


def measure():
    print("Colour: %.1f" % colorLeft.reflected_light_intensity_pc)


def main():
    drive(170)
    measure()
    for _ in range(3):
        drive(400)
        measure()
    drive(230)


main()
"""
)

_CLASS = (
    MAGIC
    + """\
class Surveyor:
    MM_PER_ROTATION = 56 * 3.14159265

    def __init__(self, tank, eye):
        self.tank = tank
        self.eye = eye
        self.levels = []

    def drive(self, mm):
        self.tank.on_for_rotations(50, 50, mm / self.MM_PER_ROTATION)

    def survey(self, hops):
        for mm in hops:
            self.drive(mm)
            self.levels.append(self.eye.reflected_light_intensity_pc)


surveyor = Surveyor(tank_drive, colorLeft)
surveyor.survey([170, 400, 400, 400])
surveyor.drive(230)
for level in surveyor.levels:
    print("Colour:", level)
"""
)

_THREAD = (
    MAGIC
    + """\
import threading
import time

done = False


def log():
    while not done:
        print("Colour:", colorLeft.reflected_light_intensity_pc)
        time.sleep(0.05)


logger = threading.Thread(target=log)
logger.start()
tank_drive.on_for_rotations(50, 50, 1600 / 175.929)
done = True
logger.join()
"""
)

_DAEMON = (
    MAGIC
    + """\
import threading
import time


def log():
    while True:
        print("Colour:", colorLeft.reflected_light_intensity_pc)
        time.sleep(0.05)


threading.Thread(target=log, daemon=True).start()
tank_drive.on_for_rotations(50, 50, 1600 / 175.929)
"""
)

_NOT_BLOCKING = (
    MAGIC
    + """\
tank_drive.on_for_rotations(50, 50, 1600 / 175.929, block=False)
while tank_drive.is_running:
    print("Colour:", colorLeft.reflected_light_intensity_pc)
"""
)

_STEERING = (
    MAGIC
    + """\
for mm in (170, 400, 400, 400):
    tank_turn.on_for_rotations(0, 50, mm / 175.929)
    print("Colour:", colorLeft.reflected_light_intensity_pc)
tank_turn.on_for_rotations(0, 50, 230 / 175.929)
"""
)

_DEGREES = (
    MAGIC
    + """\
for mm in (170, 400, 400, 400):
    tank_drive.on_for_degrees(50, 50, 360 * mm / 175.929)
    print("Colour:", colorLeft.reflected_light_intensity_pc)
tank_drive.on_for_degrees(50, 50, 360 * 230 / 175.929)
"""
)

_ENCODER = (
    MAGIC
    + """\
motor = tank_drive.left_motor
start = motor.position
tank_drive.on(30, 30)
while motor.position - start < 360 * 1600 / 175.929:
    print("Colour:", colorLeft.reflected_light_intensity_pc)
tank_drive.off()
"""
)

_STATE_MACHINE = (
    MAGIC
    + """\
state, bands = "white", 0
tank_drive.on(30, 30)
while bands < 4 or state == "band":
    level = colorLeft.reflected_light_intensity_pc
    if state == "white" and level < 95:
        state, bands = "band", bands + 1
    elif state == "band" and level > 99:
        state = "white"
    print(f"Colour: {level}")
tank_drive.off()
tank_drive.on_for_rotations(30, 30, 120 / 175.929)
"""
)

_ROUNDED = (
    MAGIC
    + """\
for mm in (170, 400, 400, 400):
    tank_drive.on_for_rotations(50, 50, mm / 175.929)
    print("Colour:", round(colorLeft.reflected_light_intensity_pc))
tank_drive.on_for_rotations(50, 50, 230 / 175.929)
"""
)

_FROM_255 = (
    MAGIC
    + """\
for mm in (170, 400, 400, 400):
    tank_drive.on_for_rotations(50, 50, mm / 175.929)
    print("Colour:", colorLeft.reflected_light_intensity / 2.55)
tank_drive.on_for_rotations(50, 50, 230 / 175.929)
"""
)

_CHATTY = (
    MAGIC
    + """\
print("Hello, I am the survey robot!")
for number, mm in enumerate((170, 400, 400, 400), start=1):
    print("driving to band", number, "...")
    tank_drive.on_for_rotations(50, 50, mm / 175.929)
    say("there", wait=False)
    print("Colour:", colorLeft.reflected_light_intensity_pc)
    print("Distance:", ultrasonic.distance_centimeters)
tank_drive.on_for_rotations(50, 50, 230 / 175.929)
print("Bye!")
"""
)

_DETOUR = (
    MAGIC
    + """\
for mm in (170, 400, 400, 400, 300):
    tank_drive.on_for_rotations(50, 50, mm / 175.929)
    print("Colour:", colorLeft.reflected_light_intensity_pc)
tank_drive.on_for_rotations(-50, -50, 70 / 175.929)
"""
)

_CRAWL = HOPS.replace("50, 50", "20, 20")

_HANDLED = (
    MAGIC
    + """\
levels = {}
for number, mm in enumerate((170, 400, 400, 400)):
    tank_drive.on_for_rotations(50, 50, mm / 175.929)
    try:
        levels["none"] += 1
    except KeyError:
        levels[number] = colorLeft.reflected_light_intensity_pc
for level in levels.values():
    print("Colour:", level)
tank_drive.on_for_rotations(50, 50, 230 / 175.929)
"""
)

_GENERATOR = (
    MAGIC
    + """\
def levels(hops):
    for mm in hops:
        tank_drive.on_for_rotations(50, 50, mm / 175.929)
        yield colorLeft.reflected_light_intensity_pc


print(*(f"Colour: {level}" for level in levels((170, 400, 400, 400))), sep="\\n")
tank_drive.on_for_rotations(50, 50, 230 / 175.929)
"""
)

_HELPERS = """\
MM_PER_ROTATION = 175.929


def hop(tank, mm):
    tank.on_for_rotations(50, 50, mm / MM_PER_ROTATION)
"""

_WITH_MODULE = (
    MAGIC
    + """\
from helpers import hop

for mm in (170, 400, 400, 400):
    hop(tank_drive, mm)
    print("Colour:", colorLeft.reflected_light_intensity_pc)
hop(tank_drive, 230)
"""
)

_WITH_DATA = (
    MAGIC
    + """\
import csv
from pathlib import Path

with open(Path(__file__).with_name("hops.csv")) as file:
    hops = [float(row[0]) for row in csv.reader(file)]
for mm in hops[:-1]:
    tank_drive.on_for_rotations(50, 50, mm / 175.929)
    print("Colour:", colorLeft.reflected_light_intensity_pc)
tank_drive.on_for_rotations(50, 50, hops[-1] / 175.929)
"""
)

_WITH_PACKAGE = (
    MAGIC
    + """\
from survey.route import HOPS, LAST
from survey import robot

for mm in HOPS:
    robot.drive(tank_drive, mm)
    print("Colour:", colorLeft.reflected_light_intensity_pc)
robot.drive(tank_drive, LAST)
"""
)

RIGHT = (
    single("ada", HOPS, "drives to the middle of each band and reads there"),
    single(
        "ben",
        _POLL,
        "polls while driving; leaves black at about x 1623, and 127 mm on is 1750 within 10 mm",
    ),
    single(
        "cleo",
        _SLEEPS,
        "at 205 mm/s a reading each 0.11 s is one each 23 mm: several on each band of 200 mm",
    ),
    single("dora", _IMPORTS, "as ada, but imports everything itself"),
    single(
        "emil",
        _SIM_MAGIC_IMPORTS,
        "as ada, with a magic line that is not Python, and the right sensor",
    ),
    single("fatma", _FUNCTIONS, "functions; prints one decimal: 86.3, 82.7, 50.2, 0.0"),
    single(
        "gregor",
        _CLASS,
        "a class; prints the levels only when it has arrived, which the task allows",
    ),
    single("hana", _THREAD, "a thread logs while the main one drives; it is joined"),
    single("igor", _DAEMON, "a daemon thread logs; it ends with the program"),
    single("jana", _NOT_BLOCKING, "drives in the background and logs until the motors stop"),
    single("karl", _STEERING, "steers straight on instead of driving two motors"),
    single("lena", _DEGREES, "degrees instead of rotations"),
    single(
        "milo",
        _ENCODER,
        "stops by the encoder: at 154 mm/s a reading each 20 ms overshoots at most 4 mm",
    ),
    single(
        "nora",
        _STATE_MACHINE,
        "counts bands; leaves the last fully at about x 1631, and 120 mm on is 1751",
    ),
    single("otto", _ROUNDED, "rounds: 86, 83, 50, 0 are within 0.5 of 86.3, 82.7, 50.2, 0"),
    single("pia", _FROM_255, "computes percent from the scale of 255: 220 / 2.55 = 86.3"),
    single("quentin", _CHATTY, "prints much else, speaks, and logs another variable"),
    single("rosa", _DETOUR, "drives to x 1820, short of the wall, and back to 1750"),
    single("sven", _CRAWL, "at speed 20, 103 mm/s: about 16 s plus the stops, less than 20 s"),
    single("tara", _HANDLED, "handles an exception of its own; it is no error of the program"),
    single("ulla", _GENERATOR, "a generator; prints all levels at once"),
    Student(
        "viktor",
        {"main.py": _WITH_MODULE, "helpers.py": _HELPERS},
        (),
        "a folder with its own module",
    ),
    Student(
        "wanda",
        {"robot.py": _WITH_DATA, "hops.csv": "170\n400\n400\n400\n230\n"},
        (),
        "a folder whose only program has another name, with a data file",
    ),
    Student(
        "xaver",
        {
            "main.py": _WITH_PACKAGE,
            "survey/__init__.py": "",
            "survey/route.py": "HOPS = (170, 400, 400, 400)\nLAST = 230\n",
            "survey/robot.py": "def drive(tank, mm):\n    tank.on_for_rotations(50, 50, mm / 175.929)\n",
        },
        (),
        "a folder with a package",
    ),
)
