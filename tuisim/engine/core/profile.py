"""Profiles: the cost of each call and the behaviour of motors, as frozen data.

`robolab` follows the text of the course; `nbev3devsim` gives the results of the old
simulator. A profile is only data: the code that reads it never checks its name.

To add a rule: add a field with a default at the end of `ProfileSpec`, with the source of its numbers and `later=True`.
To add a motor law: add it to `MotorLaw`; write the class of its motor and, if wheels move differently, of its drive in
`engine.core.drive`; add a case to `create_motor` and `build_drive` in `engine.core.motion`; write its device in
`engine.shim.motor`, with a case in
`tacho_of` in `engine.shim.brick`; add it to the source of `motor_law`; say in `MotorLaw.library` which library drives
it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from enum import StrEnum
from typing import Any

from tuisim.base.errors import ProfileError
from tuisim.engine.core.spec_fields import Spec, choice, flag, number, spec, text, whole

MS = 1_000_000
"""Nanoseconds in a millisecond."""
NS_PER_S = 1_000_000_000


def compute_due_ns(tick: int, tick_hz: int) -> int:
    """Return when a tick is due, in ns from the start: ceil(tick · 10⁹ / tick_hz)."""
    return -(-tick * NS_PER_S // tick_hz)


class Library(StrEnum):
    """The library with which a program controls the robot."""

    EV3DEV2 = "ev3dev2"
    PYBRICKS = "pybricks"

    @property
    def joins_threads(self) -> bool:
        """Whether a program waits for its threads at its end, as in Python; in MicroPython, they end with it."""
        return self is not Library.PYBRICKS

    @property
    def drops_annotations(self) -> bool:
        """Whether the compiler drops annotations without evaluating them, as that of MicroPython does."""
        return self is Library.PYBRICKS


class MotorLaw(StrEnum):
    """How motors move and execute commands, and which library controls them."""

    BRICK = "brick"
    """Motors end their moves exactly at the goal or the time, as the course defines."""
    EV3DEV = "ev3dev"
    """Motors move as on a brick with ev3dev: the electric motor and the control in its driver are simulated."""
    NBEV3DEVSIM = "nbev3devsim"
    """Motors move as in the browser simulator nbev3devsim, equal to the last bit."""
    PYBRICKS = "pybricks"
    """Motors follow trajectories, as in Pybricks 2.0."""
    PYBRICKS_4 = "pybricks-4"
    """Motors follow trajectories, as in Pybricks 4."""

    @property
    def library(self) -> Library:
        """The library that programs use to control motors under this motor law."""
        return (
            Library.PYBRICKS
            if self in (MotorLaw.PYBRICKS, MotorLaw.PYBRICKS_4)
            else Library.EV3DEV2
        )

    @property
    def is_measured(self) -> bool:
        """Whether robots behave as measured on real bricks, and not as a course or another simulator defines."""
        return self not in DRIVEN_LAWS


DRIVEN_LAWS = frozenset({MotorLaw.BRICK, MotorLaw.NBEV3DEVSIM})
"""The laws of motors that run as they are told, without a control."""


_OLD = "measured on the old simulator"
_BRICK = "measured on a brick (ev3dev-lang-python, issue 732): ev3: 1.2 ms"
_FAST = "lego-micropython: 0.35 ms, as a brick that read its colour sensor 3,000 times a second"
_NEW = "choice of this project"
MAX_COST_MS = 60_000


def _build_cost(*, default: int, source: str, later: bool = False) -> Any:
    """Return a data class field for the duration of a call in simulated ns; files may also give it in ms.

    Args:
        default: The duration if a file gives none, in ns.
        source: Where that number comes from.
        later: Whether the field was added after runs had been stored without it; see `Value`.
    """
    return whole(0, MAX_COST_MS * MS, default=default, unit="ns", source=source, later=later)


@spec
class ProfileSpec(Spec):
    """A profile: the rules by which motors, sensors and calls of one kind of brick are simulated.

    Costs are the simulated nanoseconds that a call takes.
    """

    ERROR = ProfileError

    name: str = text(what="name")
    title: str = text(what="title")
    tick_hz: int = whole(1, 1000, source=f"{_NEW}: 100; {_OLD}: 30")
    """Ticks per second; see `compute_due_ns`."""

    color_read_ns: int = _build_cost(
        default=10 * MS, source=f"{_OLD}: it waits before it takes the value; {_BRICK}; {_FAST}"
    )
    color_code_read_ns: int = _build_cost(
        default=20 * MS,
        source=f"{_OLD}: it waits twice; ev3, lego-micropython: a reading like any other",
    )
    """Duration of reading `color` or `color_name`."""
    ultrasonic_read_ns: int = _build_cost(
        default=10 * MS,
        source=f"{_OLD}: it waits before it takes the value; ev3, lego-micropython: a reading like any other",
    )
    gyro_read_ns: int = _build_cost(
        default=20 * MS,
        source=f"{_OLD}: it waits twice; ev3, lego-micropython: a reading like any other",
    )
    attribute_read_ns: int = _build_cost(
        default=1 * MS,
        source=f"{_NEW}, so that polling takes time; {_OLD}: nothing; {_BRICK}; {_FAST}",
    )
    """Duration of reading any other attribute of a device."""
    clock_read_ns: int = _build_cost(
        default=20_000, source=f"{_NEW}, so that loops on the clock end; {_OLD}: nothing"
    )
    display_update_ns: int = _build_cost(
        default=10 * MS,
        source=f"{_NEW}, an estimate: 130 steps per pixel at the brick's 300 MHz; the old simulator has none; "
        "lego-micropython: its firmware draws in C",
    )
    """`Display.update()`: it converts 22 784 pixels into 91 KB. Of Pybricks, any drawing."""

    motor_law: MotorLaw = choice(
        MotorLaw,
        default=MotorLaw.BRICK,
        source=f"{MotorLaw.BRICK}: moves end at their target, as the course says; "
        f"{MotorLaw.EV3DEV}: the driver of kernel 4.14; a large motor measured by nxt-unroller (2015), its "
        "friction from steps logged in five public repositories; of a medium one two points under load by Philo, "
        "its inertia an estimate; "
        f"{MotorLaw.NBEV3DEVSIM}: {_OLD}; {MotorLaw.PYBRICKS}, {MotorLaw.PYBRICKS_4}: the firmware's own control code",
    )
    """How motors execute commands and move."""
    max_speed_dps: float = number(
        1,
        100_000,
        default=1050.0,
        source="EV3 motor driver table: large motor without a load; "
        "lego-micropython: the motor data of its firmware, at 8 V",
    )
    """Large motor, no load (EV3 motor driver table)."""
    reflected_max: int = whole(
        1, 1000, default=255, source="ev3dev2 library: 100; the course and the old simulator: 255"
    )
    """Value of `reflected_light_intensity` on white."""
    ambient_percent: int = whole(
        0,
        1_000_000,
        default=0,
        source=f"{_NEW}: a sensor close to the mat is in its own shadow; {_OLD}: always 0",
    )
    """Value of `ambient_light_intensity` on white: the light that reaches a sensor close to the mat."""
    halfway_heading: bool = flag(
        default=False, source=f"{_NEW}, so that arcs are round; {_OLD}: the heading before the turn"
    )
    """Whether a tick moves the robot along its heading halfway through the tick's turn, not at its start."""
    ultrasonic_period_ticks: int = whole(1, 1000, default=1, source=_OLD)
    """The ultrasonic sensor measures once in this number of ticks."""
    solid: bool = flag(
        default=False, source="obstacles are solid on a real field, but not in the old simulator"
    )
    """Whether obstacles and walls stop the robot, unless the world overrides it."""
    mend_library: bool = flag(
        default=True,
        source=f"{_NEW}: see `tuisim guide library-differences`; ev3: the library as it is",
    )
    """Whether defects of the library that affect course programs are fixed."""
    starts_in_own_folder: bool = flag(
        default=False,
        later=True,
        source="ev3dev starts a program in its own folder; a course starts it in the notebook's",
    )
    """Whether a program starts in its own folder, not in the user's working directory."""
    mode_switch_ns: int = _build_cost(
        default=0,
        later=True,
        source="Pybricks 2.0, `pbdevice.c`: 30 ms; ev3: 15 ms, an estimate: the driver waits for a message in the "
        "new mode; the course, the old simulator: none",
    )
    """Time that a change to another mode takes a sensor; 0 for a change that takes no time."""
    infrared_switch_ns: int = _build_cost(
        default=0,
        later=True,
        source="Pybricks 2.0, `pbdevice.c`, and ev3: 1100 ms (pybricks/support, issue 14)",
    )
    """Time that a change to another mode takes an infrared sensor; 0 for a change that takes no time."""
    stale_reading_ns: int = _build_cost(
        default=0,
        later=True,
        source="measured on a brick (pybricks/support, issue 14): ev3: old values up to 18 ms after the change, "
        "new ones from 22 ms on; the course, the old simulator: none",
    )
    """After a change of mode, for this time a colour sensor still returns the last values of the new mode."""
    white_percent: float = number(
        50,
        100,
        default=100.0,
        later=True,
        unit="%",
        source="measured with EV3 sensors: 95 to 100 on white paper in a lit room, 83, 62 and 55 on three white "
        "surfaces in the dark (EV3 test 3, Port View); ev3: 85; the course, the old simulator: 100",
    )
    """Reflected light of white, unless a colour sensor has its own."""
    black_percent: float = number(
        0,
        49,
        default=0.0,
        later=True,
        unit="%",
        source="measured with EV3 sensors: 2 to 6 on black (EV3 test 3, Port View); ev3: 5; the course, the old "
        "simulator: 0",
    )
    """Reflected light of black, unless a colour sensor has its own."""
    brick_colors: bool = flag(
        default=False,
        later=True,
        source="the EV3 driver's table of colours; ev3: 0 for nothing and 7 for brown, too, and white only if all "
        f"channels are high, from limits that are a {_NEW}; the course, the old simulator: 1 to 6",
    )
    """Whether the colour sensor also distinguishes 0, no colour, and 7, brown."""
    min_echo_mm: int = whole(
        0,
        255,
        default=0,
        later=True,
        unit="mm",
        source="measured (ETH Zürich, with the NXT sensor): ev3: no echo below 30 mm; the course, the old simulator: 0",
    )
    """Smallest distance of a surface whose echo an ultrasonic sensor hears; a closer surface reads as one without an
    echo."""
    gyro_max_dps: int = whole(
        0,
        100_000,
        default=0,
        later=True,
        unit="°/s",
        source="the EV3 driver's table of sensors; ev3: 440; 0, as in the course and the old simulator: no limit",
    )
    """The highest rate of turn that a gyro senses: its angle misses what is beyond."""
    gyro_restarts: bool = flag(
        default=False,
        later=True,
        source="ev3dev-lang-python, issue 517, and ev3dev, issue 402: ev3: the angle restarts from 0; the course, "
        "the old simulator: it goes on",
    )
    """Whether a change of mode sets the angle of a gyro to 0, unless the sensor keeps it."""

    attribute_write_ns: int = _build_cost(
        default=0,
        later=True,
        source="measured on a brick (ev3dev-lang-python, issue 732): 1.1 ms; the course, the old simulator: nothing",
    )
    """Duration of writing any attribute of a device."""
    cached_read_ns: int = _build_cost(
        default=0,
        later=True,
        source="measured on a brick (ev3dev-lang-python, issue 732): 0.14 ms; the course, the old simulator: nothing",
    )
    """Duration of reading an attribute that the library has read before and remembers, such as `max_speed`."""


ROBOLAB = ProfileSpec(
    name="robolab",
    title="the course as its text says, with bugs fixed",
    tick_hz=100,
    ambient_percent=10,
    halfway_heading=True,
)

NBEV3DEVSIM = ProfileSpec(
    name="nbev3devsim",
    title="the numbers of the old simulator",
    tick_hz=30,
    attribute_read_ns=0,
    clock_read_ns=0,
    motor_law=MotorLaw.NBEV3DEVSIM,
    ultrasonic_period_ticks=3,
)

EV3 = ProfileSpec(
    name="ev3",
    title="what the real brick does",
    tick_hz=100,
    color_read_ns=1_200_000,
    color_code_read_ns=1_200_000,
    ultrasonic_read_ns=1_200_000,
    gyro_read_ns=1_200_000,
    attribute_read_ns=1_200_000,
    attribute_write_ns=1_100_000,
    cached_read_ns=140_000,
    motor_law=MotorLaw.EV3DEV,
    reflected_max=100,
    ambient_percent=10,
    halfway_heading=True,
    solid=True,
    mend_library=False,
    starts_in_own_folder=True,
    mode_switch_ns=15 * MS,
    infrared_switch_ns=1100 * MS,
    stale_reading_ns=20 * MS,
    white_percent=85.0,
    black_percent=5.0,
    brick_colors=True,
    min_echo_mm=30,
    gyro_max_dps=440,
    gyro_restarts=True,
)

LEGO_MICROPYTHON = replace(
    EV3,
    name="lego-micropython",
    title="LEGO's MicroPython for the EV3: Pybricks 2.0",
    color_read_ns=350_000,
    color_code_read_ns=350_000,
    ultrasonic_read_ns=350_000,
    gyro_read_ns=350_000,
    attribute_read_ns=350_000,
    attribute_write_ns=0,
    cached_read_ns=0,
    display_update_ns=1 * MS,
    motor_law=MotorLaw.PYBRICKS,
    max_speed_dps=930.0,
    mode_switch_ns=30 * MS,
)

PYBRICKS_4 = replace(
    LEGO_MICROPYTHON,
    name="pybricks4",
    title="Pybricks 4, on the EV3 and on other hubs: faster ramps, more names",
    motor_law=MotorLaw.PYBRICKS_4,
)

PROFILES: Mapping[str, ProfileSpec] = {
    profile.name: profile for profile in (ROBOLAB, NBEV3DEVSIM, EV3, LEGO_MICROPYTHON, PYBRICKS_4)
}
"""All profiles, by name."""
