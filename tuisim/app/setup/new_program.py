"""The text of a new program: its mat as a magic line, a sensor, and a skeleton to start from."""

from __future__ import annotations

from enum import StrEnum
from typing import NamedTuple

from tuisim.config.program_file import with_mat


class Skeleton(StrEnum):
    """What a new program does at first."""

    LOG = "log"
    UNTIL = "until"
    LIBRARY = "library"
    EMPTY = "empty"


SKELETON_TITLES = {
    Skeleton.LOG: "Drive and log",
    Skeleton.UNTIL: "Drive until …",
    Skeleton.LIBRARY: "Real robot's imports",
    Skeleton.EMPTY: "Empty",
}


class SkeletonSensor(NamedTuple):
    """What a sensor of the usual robot tells a program."""

    noun: str
    """The sensor in words."""
    sample: str
    """Name of its samples."""
    value: str
    """Attribute of its object."""
    made: str
    """Class and port, as the prelude makes the object."""
    goes_on: str
    """Condition under which the robot drives on."""
    speeds: tuple[int, int] = (50, 50)
    """Of the left and the right wheel in percent."""


_LIGHT = "reflected_light_intensity_pc"
READINGS = {
    "colorLeft": SkeletonSensor(
        "left light sensor", "Light", _LIGHT, "ColorSensor(INPUT_2)", "> 5"
    ),
    "colorRight": SkeletonSensor(
        "right light sensor", "Light", _LIGHT, "ColorSensor(INPUT_3)", "> 5"
    ),
    "ultrasonic": SkeletonSensor(
        "ultrasonic sensor", "Distance", "distance_centimeters", "UltrasonicSensor(INPUT_1)", "> 20"
    ),
    "gyro": SkeletonSensor("gyro", "Angle", "angle", "GyroSensor(INPUT_4)", "< 90", (30, 10)),
}
"""By name of its object in the prelude."""

_LOG = """\
{drive}.on(SpeedPercent({speeds[0]}), SpeedPercent({speeds[1]}))
for step in range(60):
    print("{sample}: " + str({instance}.{value}))
    time.sleep(0.1)
{drive}.off()
"""
_UNTIL = """\
{drive}.on(SpeedPercent({speeds[0]}), SpeedPercent({speeds[1]}))
while {instance}.{value} {goes_on}:
    print("{sample}: " + str({instance}.{value}))
    time.sleep(0.1)
{drive}.off()
"""
_LIBRARY = """\
from ev3dev2.motor import OUTPUT_B, OUTPUT_C, MoveTank, SpeedPercent
from ev3dev2.sensor import {port}
from ev3dev2.sensor.lego import {type}

tank = MoveTank(OUTPUT_B, OUTPUT_C)
{instance} = {made}

"""
_SAYS = {
    Skeleton.LOG: "Log the {noun} sixty times while driving.",
    Skeleton.UNTIL: "Drive until the {noun} says stop.",
    Skeleton.LIBRARY: "Log the {noun} sixty times while driving, as on a real robot.",
    Skeleton.EMPTY: "A new program.",
}
OF_THE_BRICK = "sim_magic", "--profile ev3"
"""Magic and words of a program with imports: it runs as on the brick."""


def program_text(mat: str, sensor: str, skeleton: Skeleton) -> str:
    """Return the text of a new program.

    Args:
        mat: Name of the mat, or path of its image.
        sensor: One of `READINGS`.
        skeleton: What the program does.
    """
    reading = READINGS[sensor]
    kind, _, port = reading.made.rstrip(")").partition("(")
    words = {
        **reading._asdict(),
        "instance": sensor,
        "type": kind,
        "port": port,
        "drive": "tank_drive",
    }
    head = f'"""{_SAYS[skeleton].format(**words)}"""\n'
    match skeleton:
        case Skeleton.EMPTY:
            return with_mat(head, "", mat) + "\n"
        case Skeleton.LIBRARY:
            # The course's own name for it is not in the library.
            words |= {"drive": "tank", "value": reading.value.removesuffix("_pc")}
            magic = with_mat("# %%{} {}\n".format(*OF_THE_BRICK), "", mat)
            return head + magic + "\nimport time\n\n" + (_LIBRARY + _LOG).format(**words)
        case Skeleton.LOG | Skeleton.UNTIL:
            body = _LOG if skeleton is Skeleton.LOG else _UNTIL
            return with_mat(head, "", mat) + "\nimport time\n\n" + body.format(**words)
