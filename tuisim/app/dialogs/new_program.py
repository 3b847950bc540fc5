"""The dialog of a new program: its mat, the sensor that it reads, and its skeleton, with the text that they make."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from enum import StrEnum
from typing import ClassVar, NamedTuple

from textual import events, on
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.containers import Horizontal
from textual.widgets import OptionList, Static
from textual.widgets.option_list import Option

from tuisim.app.dialogs.dialog import Dialog
from tuisim.programs.program_file import replace_mat


class Skeleton(StrEnum):
    """The first content of a new program, such as a loop that logs a sensor; `EMPTY` is a program without a loop."""

    LOG = "log"
    UNTIL = "until"
    LIBRARY = "library"
    PYBRICKS = "pybricks"
    PRIME_HUB = "prime_hub"
    EMPTY = "empty"


SKELETON_TITLES = {
    Skeleton.LOG: "Drive and log",
    Skeleton.UNTIL: "Drive until …",
    Skeleton.LIBRARY: "Real robot's imports",
    Skeleton.PYBRICKS: "Pybricks: EV3",
    Skeleton.PRIME_HUB: "Pybricks: PrimeHub",
    Skeleton.EMPTY: "Empty",
}


class SkeletonSensor(NamedTuple):
    """The words and expressions for one sensor of the usual robot, from which the text of a new program is composed."""

    noun: str
    """What the sensor is called in the dialog's list, and in sentences about a program."""
    sample: str
    """Name of the samples that the program prints."""
    value: str
    """Attribute of the sensor's object that the program reads."""
    made: str
    """Expression that makes the object, with class and port, as in the prelude."""
    goes_on: str
    """Python condition on the reading under which the robot of the new program drives on."""
    method: str
    """Method of the sensor's object that returns the reading in Pybricks."""
    hub_made: str
    """Expression that makes the object in Pybricks on a PrimeHub, with class and port."""
    speeds: tuple[int, int] = (50, 50)
    """Speeds of the left and the right wheel in percent of the greatest speed."""
    turn_rate_dps: int = 0


_LIGHT = "reflected_light_intensity_pc"
READINGS = {
    "colorLeft": SkeletonSensor(
        *("left light sensor", "Light", _LIGHT, "ColorSensor(INPUT_2)", "> 6"),
        *("reflection", "ColorSensor(Port.C)"),
    ),
    "colorRight": SkeletonSensor(
        *("right light sensor", "Light", _LIGHT, "ColorSensor(INPUT_3)", "> 6"),
        *("reflection", "ColorSensor(Port.D)"),
    ),
    "ultrasonic": SkeletonSensor(
        *("ultrasonic sensor", "Distance", "distance_centimeters", "UltrasonicSensor(INPUT_1)"),
        *("> 20", "distance", "UltrasonicSensor(Port.E)"),
    ),
    "gyro": SkeletonSensor(
        *("gyro", "Angle", "angle", "GyroSensor(INPUT_4)", "< 90"),
        *("angle", "hub.imu", (30, 10), 30),
    ),
}
"""The sensors by the names of their objects in the prelude."""

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
_PYBRICKS = """\
from pybricks.ev3devices import {type}, Motor
from pybricks.hubs import EV3Brick
from pybricks.parameters import Port
from pybricks.robotics import DriveBase
from pybricks.tools import wait

hub = EV3Brick()
robot = DriveBase(Motor(Port.B), Motor(Port.C), wheel_diameter=56, axle_track=180)
{instance} = {type}(Port.S{port[6]})

"""
_PRIME_HUB = """\
from pybricks.hubs import PrimeHub
from pybricks.parameters import Direction, Port
from pybricks.pupdevices import {imports}
from pybricks.robotics import DriveBase
from pybricks.tools import wait

hub = PrimeHub()
left = Motor(Port.A, Direction.COUNTERCLOCKWISE)
robot = DriveBase(left, Motor(Port.B), wheel_diameter=56, axle_track=112)
{instance} = {hub_made}

"""
_LOG_PYBRICKS = """\
robot.drive(100, {turn_rate_dps})
for step in range(60):
    print("{sample}: " + str({instance}.{method}()))
    wait(100)
robot.stop()
"""
_SAYS = {
    Skeleton.LOG: "Log the {noun} sixty times while driving.",
    Skeleton.UNTIL: "Drive until the {noun} reaches a limit.",
    Skeleton.LIBRARY: "Log the {noun} sixty times while driving, as on a real robot.",
    Skeleton.PYBRICKS: "Log the {noun} sixty times while driving (Pybricks).",
    Skeleton.PRIME_HUB: "Log the {noun} sixty times while driving (Pybricks).",
    Skeleton.EMPTY: "A new program.",
}
_EXPLAINS = "# Chooses the mat, and defines tank_drive, colorLeft and other names.\n"
_EXPLAINS_BRICK = "# Chooses the mat; the program runs as on a brick or hub.\n"
BRICK_MAGIC = "sim_magic", "--profile ev3"
"""Name of the magic, and its options, in the first line of a new program that runs as on the brick."""


def build_program_text(mat: str, sensor: str, skeleton: Skeleton) -> str:
    """Return the text of a new program.

    Args:
        mat: Name of the mat, or path of its image.
        sensor: The sensor that it reads, one of `READINGS`.
        skeleton: What the program does with the sensor.
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
    begins = replace_mat(head, "", mat) + _EXPLAINS
    match skeleton:
        case Skeleton.EMPTY:
            return begins + "\n"
        case Skeleton.LIBRARY:
            # The library lacks the attribute of the course, whose name ends in `_pc`.
            words |= {"drive": "tank", "value": reading.value.removesuffix("_pc")}
            magic = replace_mat("# %%{} {}\n".format(*BRICK_MAGIC), "", mat) + _EXPLAINS_BRICK
            return head + magic + "\nimport time\n\n" + (_LIBRARY + _LOG).format(**words)
        case Skeleton.PYBRICKS | Skeleton.PRIME_HUB:
            words["imports"] = "Motor" if sensor == "gyro" else f"{kind}, Motor"
            if skeleton is Skeleton.PRIME_HUB and sensor == "gyro":
                words["method"] = "heading"
            body = _PYBRICKS if skeleton is Skeleton.PYBRICKS else _PRIME_HUB
            begins = replace_mat(head + "# %%sim_magic\n", "", mat) + _EXPLAINS_BRICK
            return begins + "\n" + (body + _LOG_PYBRICKS).format(**words)
        case Skeleton.LOG | Skeleton.UNTIL:
            body = _LOG if skeleton is Skeleton.LOG else _UNTIL
            return begins + "\nimport time\n\n" + body.format(**words)


_LISTS = {"mat": "Mat", "sensor": "Sensor", "skeleton": "Program"}
"""The titles of the lists, by id."""


class NewProgramDialog(Dialog[str]):
    """The dialog with the mats, sensors and skeletons of a new program; it returns the text of the program.

    Args:
        mats: The titles of the mats to choose from, by the word for the mat in a magic line.
        current: The word of the current mat, which is selected at first.
    """

    TITLE_TEXT: str = "A new program"
    HINT: str = "Letters or ↑ ↓ choose · ← → next list · Enter begins · Escape closes"
    BINDINGS: ClassVar[list[BindingType]] = [
        ("right,tab", "app.focus_next", "Next list"),
        ("left,shift+tab", "app.focus_previous", "Previous list"),
    ]

    def __init__(self, mats: Mapping[str, str], current: str) -> None:
        super().__init__()
        self._offers: Sequence[Mapping[str, str]] = (
            mats,
            {name: reading.noun.capitalize() for name, reading in READINGS.items()},
            {str(skeleton): title for skeleton, title in SKELETON_TITLES.items()},
        )
        self._current = current
        self._typed = ""
        """Letters that the user has typed while a list had the focus, to find an entry of that list."""

    def compose_content(self) -> ComposeResult:
        with Horizontal():
            for name, offers in zip(_LISTS, self._offers, strict=True):
                listed = OptionList(
                    *(Option(title, id=word) for word, title in offers.items()),
                    id=name,
                    markup=False,
                )
                listed.border_title = _LISTS[name]
                listed.highlighted = (
                    [*offers].index(self._current) if self._current in offers else 0
                )
                yield listed
        yield Static(id="text", markup=False)

    def on_mount(self) -> None:
        self.query_one("#mat").focus()

    @on(events.DescendantFocus)
    def _forget_typed(self) -> None:
        self._typed = ""

    def on_key(self, event: events.Key) -> None:
        """Select the first entry that matches the letters typed so far in the focused list."""
        listed = self.focused
        if not event.character or not event.is_printable or not isinstance(listed, OptionList):
            return
        event.stop()
        titles = [*self._offers[[*_LISTS].index(listed.id or "")].values()]
        for typed in (self._typed + event.character.lower(), event.character.lower()):
            if (index := _find_title(titles, typed)) is not None:
                self._typed = typed
                listed.highlighted = index
                return

    @on(OptionList.OptionHighlighted)
    def _show(self) -> None:
        self.query_one("#text", Static).update(self._build_text())

    @on(OptionList.OptionSelected)
    def _submit(self) -> None:
        self.dismiss(self._build_text())

    def _build_text(self) -> str:
        mat, sensor, skeleton = (
            [*offers][self.query_one(f"#{name}", OptionList).highlighted or 0]
            for name, offers in zip(_LISTS, self._offers, strict=True)
        )
        return build_program_text(mat, sensor, Skeleton(skeleton))


def _find_title(titles: Sequence[str], typed: str) -> int | None:
    """Return the index of the first title that begins with a text.

    If there is none, return the index of the first title that has the letters of the text in their order; else None.
    """
    for fits in (lambda title: title.startswith(typed), lambda title: _has_letters(title, typed)):
        if (
            index := next(
                (index for index, title in enumerate(titles) if fits(title.lower())), None
            )
        ) is not None:
            return index
    return None


def _has_letters(title: str, typed: str) -> bool:
    left = iter(title)
    return all(letter in left for letter in typed)
