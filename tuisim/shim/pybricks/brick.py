"""The simulated brick as the library's classes see it, and the errors that they raise."""

from __future__ import annotations

import errno
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

from tuisim.core.servo.motor import ServoMotor
from tuisim.shim.display import Screen
from tuisim.shim.leds import Lights
from tuisim.shim.power import Battery
from tuisim.shim.sensors import LegoSensor
from tuisim.shim.session import DeviceSession
from tuisim.shim.sound import Mixer
from tuisim.shim.waits import Wait, waits_for

POLL_US = 5000
"""A blocking call looks for the end of its move this often, as the firmware's does."""


@dataclass(slots=True)
class Brick:
    """The brick of one run."""

    session: DeviceSession
    motors: Mapping[str, ServoMotor]
    """By port, such as `outA`."""
    sensors: Mapping[str, LegoSensor]
    lights: Lights
    battery: Battery
    screen: Screen
    mixer: Mixer
    hint: Callable[[str], str]
    """Returns what is on the ports of a class of devices."""
    stalled: set[str] = field(default_factory=set)
    """The ports of motors of which it was said that they are stalled."""
    said: set[str] = field(default_factory=set)
    """What was said that is said once, by subject."""

    @property
    def now_us(self) -> int:
        """The simulated time."""
        return self.session.now // 1000

    def read(self) -> int:
        """Let the time of a reading pass, and return the simulated time."""
        session = self.session
        session.charge(session.sim.spec.profile.attribute_read_ns)
        return session.now // 1000

    def command(self) -> int:
        """Count a command, which takes no time, and return the simulated time."""
        self.session.command()
        return self.session.now // 1000

    @waits_for(Wait.MOTOR)
    def wait_until(self, done: Callable[[int], bool], end_us: Callable[[], int | None]) -> None:
        """Block until a move is done.

        Args:
            done: Whether it is, at a time.
            end_us: When its trajectory ends.
        """
        begin = now = self.now_us
        while not done(now):
            until = max(end_us() or 0, now + 1)
            until = begin - (begin - until) // POLL_US * POLL_US
            self.session.wait_for_motor((until - now) * 1000)
            now = self.now_us

    def say_stalled(self, port: str, call: str) -> None:
        """Say once that a call waits for a motor that something blocks."""
        if port not in self.stalled:
            self.stalled.add(port)
            self.say(f"the motor on {port} is stalled: {call} waits until it can go on, as on the brick")

    def say_once(self, subject: str, text: str) -> None:
        """Say something to the user, unless something was said of the subject."""
        if subject not in self.said:
            self.said.add(subject)
            self.say(text)

    def say(self, text: str) -> None:
        """Say something to the user, in the program's error output."""
        print(f"tuisim: {text}", file=sys.__stderr__)


class Connected:
    """A class of the library: its objects are parts of the brick."""

    brick: ClassVar[Brick]

    def __init_subclass__(cls, **named: Any) -> None:
        super().__init_subclass__(**named)
        cls.__module__ = cls.__module__.replace("tuisim.shim.", "", 1)


def invalid_argument() -> ValueError:
    """Return the firmware's error about a bad value."""
    return ValueError("Invalid argument")


def refused(text: str) -> RuntimeError:
    """Return the error that MicroPython raises for what the firmware does not have."""
    return NotImplementedError(text)  # as on the brick


def not_permitted() -> OSError:
    """Return the firmware's error about a command that must not be given now."""
    return OSError(
        errno.EPERM,
        "EPERM:\n\nThis operation is not permitted now: the motor is in use by a drive base, or a move is under way."
        "\n--> Call stop() first.",
    )


def no_device(hint: str) -> OSError:
    """Return the firmware's error about a port without the device.

    Args:
        hint: What is on the ports.
    """
    return OSError(
        errno.ENODEV,
        f"ENODEV:\n\nA sensor or motor is not connected to the specified port.\n--> Check the port of the program, "
        f"and the robot.\n--> {hint}",
    )


def whole(value: Any) -> int:
    """Return a number as the firmware takes it: without its fraction.

    Raises:
        TypeError: it is no number.
    """
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise TypeError(f"can't convert {type(value).__name__} to int")
    return int(value)


def text_of(value: Any) -> str:
    """Return a text where the firmware takes nothing else.

    Raises:
        TypeError: it is no text.
    """
    if not isinstance(value, str):
        raise TypeError(f"can't convert '{type(value).__name__}' object to str implicitly")
    return value
