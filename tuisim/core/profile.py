"""Profiles: how much each call costs and how a motor behaves, as frozen data.

`robolab` is the course as its text says; `nbev3devsim` gives the figures of the old
simulator. A profile is only data: the code that reads it never asks for its name.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

MS = 1_000_000
"""Nanoseconds in a millisecond."""


@dataclass(frozen=True, slots=True)
class ProfileSpec:
    """The rules of one kind of brick. Costs are simulated nanoseconds a call."""

    name: str
    title: str
    tick_hz: int
    """Ticks a second: tick k falls due at ceil(k * 10^9 / tick_hz) ns."""

    color_read_ns: int = 10 * MS
    color_code_read_ns: int = 20 * MS
    """`color` and `color_name`."""
    ultrasonic_read_ns: int = 10 * MS
    gyro_read_ns: int = 20 * MS
    attribute_read_ns: int = 1 * MS
    """Any other device attribute."""
    clock_read_ns: int = 20_000
    display_update_ns: int = 10 * MS
    """`Display.update()`: it turns 22 784 pixels into 91 KB."""

    max_speed_dps: float = 1050.0
    """Large motor, no load (EV3 motor driver table)."""
    reflected_max: int = 255
    """What `reflected_light_intensity` gives on white."""
    ambient_percent: int = 0
    """What `ambient_light_intensity` gives on white: the light that a sensor close to the mat still gets."""
    round_forward_speeds: bool = False
    """Round a wheel speed of 0 or more to whole degrees per second each tick."""
    halve_position_moves: bool = False
    """A move to a position covers about half the distance: the encoder counts twice a tick."""
    keep_speed_when_stopped: bool = False
    """A stopped motor remembers its speed, and the next start begins with it."""
    timed_stop_skips_tick: bool = False
    """A timed move does not move in the tick at which its time is up."""
    direction_from_set_point: bool = False
    """A move to an absolute position goes the way of the set point's sign, not of the difference."""
    motor_ramps: bool = True
    """The ramp set points of a motor slow its changes of speed down."""
    chain_relative_moves: bool = True
    """A relative move that follows another counts from the other's target, not from the position."""
    pair_tail_ns: int = 0
    """How long a blocking call on two motors stands still after the move."""
    halfway_heading: bool = False
    """A tick moves the robot along the heading it has halfway through its turn, not along that before it."""
    forward_noise_only: bool = False
    """Motor noise works on speeds of 0 or more only, also on a wheel that stands."""
    ultrasonic_period_ticks: int = 1
    """The ultrasonic sensor measures every so many ticks."""
    solid: bool = False
    """Obstacles and walls stop the robot, unless the world says otherwise."""
    plain_state: bool = False
    """A motor's `state` is a string, '' or 'running', and `time_sp` is in seconds."""
    mend_library: bool = True
    """What the library does wrong and course programs need is put right."""
    starts_in_own_folder: bool = False
    """A program starts in the folder that it is in, not where the user is."""


ROBOLAB = ProfileSpec(
    name="robolab",
    title="the course as its text says, defects mended",
    tick_hz=100,
    ambient_percent=10,
    halfway_heading=True,
)

NBEV3DEVSIM = ProfileSpec(
    name="nbev3devsim",
    title="the figures of the old simulator",
    tick_hz=30,
    attribute_read_ns=0,
    clock_read_ns=0,
    round_forward_speeds=True,
    halve_position_moves=True,
    keep_speed_when_stopped=True,
    timed_stop_skips_tick=True,
    direction_from_set_point=True,
    motor_ramps=False,
    chain_relative_moves=False,
    pair_tail_ns=110 * MS,
    forward_noise_only=True,
    ultrasonic_period_ticks=3,
    plain_state=True,
)

EV3 = ProfileSpec(
    name="ev3",
    title="what the real brick does",
    tick_hz=100,
    color_code_read_ns=10 * MS,
    gyro_read_ns=10 * MS,
    reflected_max=100,
    ambient_percent=10,
    halfway_heading=True,
    solid=True,
    mend_library=False,
    starts_in_own_folder=True,
)

PROFILES: Mapping[str, ProfileSpec] = {profile.name: profile for profile in (ROBOLAB, NBEV3DEVSIM, EV3)}
"""Every profile by name."""
