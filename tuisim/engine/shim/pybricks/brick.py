"""The simulated brick as the classes of the library use it, and the errors that they raise."""

from __future__ import annotations

import errno
import sys
from collections.abc import Callable, Generator, Mapping, Sequence
from dataclasses import field
from math import nan
from typing import Any, ClassVar, TypeVar

from tuisim.base.data_class import dataclass
from tuisim.engine.core.commands.calls import MAX_NUMBER, Call
from tuisim.engine.core.commands.table import obey
from tuisim.engine.core.hub_spec import HUBS
from tuisim.engine.core.sensors import SENSORS
from tuisim.engine.core.servo.motor import ServoMotor
from tuisim.engine.runs.readings import READING_CODES
from tuisim.engine.shim.brick import BuiltBrick
from tuisim.engine.shim.display import Screen
from tuisim.engine.shim.plugs import PART_OF_DRIVER, PART_OF_KIND, Plugs
from tuisim.engine.shim.pybricks.parameters import find_port
from tuisim.engine.shim.sensors import LegoSensor
from tuisim.engine.shim.session import DeviceSession
from tuisim.engine.shim.sound import Mixer
from tuisim.engine.shim.waits import Wait, waits_for

LARGEST = int(MAX_NUMBER)
POLL_US = 5000
"""Interval in µs at which a blocking call checks whether its move has ended, as in the firmware."""

BLOCKED_POLL_US = 100_000
"""Longest time in µs between two checks of a blocking call while something blocks a motor: then the user learns that
the motor is stalled.
"""


Result = TypeVar("Result")
Waiting = Generator[int, None, Result]
"""A generator for a call that takes time: it yields each time, in µs since the start, until which to wait, and returns
the call's result.
"""


class Awaited:
    """The awaitable object that a blocking call returns while a task runs.

    Args:
        waiting: Yields the times until which the call waits.
        stop: Ends the motion or sound that the call has begun, if the task that awaits it is closed.
    """

    def __init__(self, waiting: Waiting[Any], stop: Callable[[], object]) -> None:
        self._waiting, self.stop = waiting, stop

    def __await__(self) -> Waiting[Any]:
        try:
            return (yield from self._waiting)
        except GeneratorExit:
            self.stop()
            raise


@dataclass(slots=True)
class Brick:
    """The part of the brick that the simulated classes of Pybricks use: motors, sensors, clock and messages."""

    session: DeviceSession
    built: BuiltBrick
    plugs: Plugs
    screen: Screen
    mixer: Mixer
    hint: Callable[[str], str]
    """Returns a hint that lists the robot's devices of a kernel class, such as its motors, with their ports."""
    name_replacement: Callable[[str, str], str] = lambda *_: ""
    """Takes the name of a class and of an attribute that the class lacks; returns a colon and what to use instead, or
    an empty text if that is unknown.
    """
    said: set[str] = field(default_factory=set)
    """The subjects of messages that have been printed, see `say_once`."""
    led_levels: Mapping[str, int] = field(default_factory=dict)
    """Brightness of the LEDs of a hub, 0 to 255, by their names in `BrickState.leds`; empty until one was lit."""
    in_task: bool = False
    """Whether a task of the program runs (Pybricks 4), so that calls return an object to await in place of blocking."""

    def find_motor(self, port: str) -> ServoMotor | None:
        """Return the motor on a port such as `outA`, which is plugged in if missing; None if there can be none."""
        if port not in self.built.motors:
            hub = self.session.sim.spec.robot.hub
            self.plugs.add(PART_OF_KIND[HUBS[hub].motor if hub else "large"], port)
        self.plugs.take_hold(self.plugs.find_path(port))
        motor = self.built.motors.get(port)
        return motor if isinstance(motor, ServoMotor) else None

    def find_sensor(self, port: str, kind: str) -> LegoSensor | None:
        """Return the sensor on a port, which is plugged in if it is missing; None if there can be none.

        Args:
            port: The port, such as `in1`.
            kind: One of `engine.core.sensors.SENSORS`; empty for any of them.
        """
        driver = SENSORS[kind].driver_name if kind else ""
        sensors = self.built.sensors
        sensor = sensors.get(port)
        if kind and (sensor is None or sensor.driver_name != driver):
            sensor = sensors[port] if self.plugs.add(PART_OF_DRIVER[driver], port) else None
        self.plugs.take_hold(self.plugs.find_path(port) if sensor else "")
        return sensor

    @property
    def now_us(self) -> int:
        """The simulated time in microseconds."""
        return self.session.now // 1000

    def read(self, mode: str = "", *ports: str) -> int:
        """Let the time of a reading pass, record the reading, and return the simulated time in microseconds.

        Args:
            mode, ports: The mode and the ports of the recorded reading, as in `engine.runs.readings.READING_CODES`.
        """
        session = self.session
        if not session.free:
            codes = [READING_CODES[port, mode] for port in ports]
            session.spend(session.sim.spec.profile.attribute_read_ns, *codes[:1])
            for code in codes[1:]:
                session.note_reading(code)
        return session.now // 1000

    def tell(self, part: int, call: Call, *values: float | None) -> None:
        """Give a command with its values to a simulated motor or drive base, at the present time.

        Args:
            part: Its number.
            call: The kind of command.
            values: The values. None stands for a value that the program does not give, and is passed as NaN; numbers
                beyond `LARGEST` are cut off.
        """
        numbers = (
            nan if value is None else float(max(-LARGEST, min(LARGEST, value))) for value in values
        )
        obey(self.session.sim, self.session.now, part, call, *numbers)

    def command(self) -> int:
        """Count a command of the program, and return the simulated time in microseconds.

        The command takes no simulated time, as long as there are not too many; see `DeviceSession.command`.
        """
        self.session.command()
        return self.session.now // 1000

    def until_done(self, done: Callable[[int], bool], control: Any) -> Waiting[None]:
        """Wait until a move is done: yield the times in microseconds at which to check again.

        Args:
            done: Returns whether the move is done at a time in microseconds.
            control: The controller or drive base that executes the move.
        """
        begin = now = self.now_us
        trajectory = control.trajectory
        while not (done(now) or (self.in_task and control.trajectory is not trajectory)):
            until = max(control.end_us or 0, now + 1)
            if any(motor.blocked_ticks for motor in self.built.motors.values()):
                until = min(until, now + BLOCKED_POLL_US)
            yield begin - (begin - until) // POLL_US * POLL_US
            now = self.now_us

    def finish(self, waiting: Waiting[Result], stop: Callable[[], object] = lambda: None) -> Result:
        """Block until a wait is over, and return its result; while a task runs, return an object to await.

        Args:
            waiting: Yields the times until which the call waits; its result is the result of the wait.
            stop: Ends the motion or sound that the call has begun, if the task that awaits the object is closed.
        """
        awaited: Any = Awaited(waiting, stop)
        return awaited if self.in_task else self.block(waiting)

    @waits_for(Wait.MOTOR)
    def block(self, waiting: Waiting[Result]) -> Result:
        """Block until a wait, which yields times in microseconds, is over; return its result."""
        while True:
            try:
                until_us = waiting.send(None) or self.command()
            except StopIteration as end:
                self.session.held_up = ""
                result: Result = end.value
                return result
            self.session.wait_for_motor((until_us - self.now_us) * 1000)

    def require_no_task(self) -> None:
        """Check that the program is not inside `run_task`, where some calls are not allowed.

        Raises:
            RuntimeError: `run_task` is running.
        """
        if self.in_task:
            raise RuntimeError("This can only be called before multitasking starts.")

    def say_stalled(self, what: str, call: str) -> None:
        """Print a message that a call waits because something blocks a motor; print it only once for each blocked part.

        Args:
            what: What is blocked, with its verb, such as `the wheels are`.
            call: The call that waits.
        """
        told = f"{what} stalled: {call} waits until the way is free, as on the brick"
        self.session.held_up = told
        self.say_once(what, told)

    def say_once(self, subject: str, text: str) -> None:
        """Print a message to the program's error output, unless one on this subject was printed before."""
        if subject not in self.said:
            self.said.add(subject)
            print(f"tuisim: {text}", file=sys.__stderr__)


class Connected:
    """Base class of the simulated classes of Pybricks whose objects are parts of the brick."""

    brick: ClassVar[Brick]

    port: Any = None
    """The port to which the device is connected, as the program gave it; None for a part inside the brick."""

    def _take_port(self, port: Any, names: Sequence[str]) -> str:
        """Store the port to which the device is connected, and return the port's name in the robot.

        Args:
            port: The port that the program gives.
            names: The names of the robot's ports for such devices.

        Raises:
            RuntimeError: a task runs.
            TypeError: `port` is not a port.
            ValueError: its name is not in `names`.
        """
        self.brick.require_no_task()
        name = find_port(port)
        if name not in names:
            raise ValueError("Invalid port")
        self.port = port
        return name

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.port or ''})"

    def __getattr__(self, name: str) -> Any:
        hint = self.brick.name_replacement(type(self).__name__, name)
        raise AttributeError(
            f"{type(self).__name__!r} object has no attribute {name!r}{hint}", name=name, obj=self
        )

    def __dir__(self) -> list[str]:
        # Python's "Did you mean" and editors propose names from here: only public ones.
        return [name for name in super().__dir__() if not name.startswith("_")]


def invalid_argument() -> ValueError:
    """Return the ValueError that the firmware raises for a bad value."""
    return ValueError("Invalid argument")


def refused(text: str) -> RuntimeError:
    """Return the error that MicroPython raises for a feature that the firmware does not have."""
    return NotImplementedError(text)  # as on the brick


FirmwareError: Any = type("OSError", (OSError,), {"__module__": "builtins"})
"""A class shown as `OSError`, like the errors on the brick: for some numbers, `OSError` itself would create an object
of a subclass, such as PermissionError.
"""


def not_permitted() -> Any:
    """Return the firmware's error for a command to a motor that a drive base or a move is using."""
    return FirmwareError(
        errno.EPERM,
        "EPERM:\n\nThis operation is not permitted now: the motor is in use by a drive base, or a move is under way."
        "\n--> Call stop() first.",
    )


def build_busy_error() -> Any:
    """Return the firmware's error for creating a drive base with motors that another drive base uses."""
    return FirmwareError(
        errno.EBUSY,
        "EBUSY:\n\nAnother DriveBase has these motors.\n--> Make one DriveBase, and use it everywhere.",
    )


def no_device(hint: str) -> Any:
    """Return the firmware's error for a port on which there is no such motor or sensor.

    Args:
        hint: Names the devices on the ports.
    """
    return FirmwareError(
        errno.ENODEV,
        f"ENODEV:\n\nA sensor or motor is not connected to the specified port.\n--> Check the port of the program, "
        f"and the robot.\n--> {hint}",
    )


def whole(value: Any) -> int:
    """Return a number cut to its whole part, as the firmware converts it: 2 for 2.9, and -2 for -2.9.

    Raises:
        TypeError: it is not a number.
    """
    if not isinstance(value, int | float):
        raise TypeError(f"can't convert {type(value).__name__} to int")
    return int(value)


def round_number(value: float) -> float:
    """Return a number rounded to four decimals and seven digits in all, as the floats of a hub have."""
    return float(f"{round(value, 4):.7g}") + 0.0


def text_of(value: Any) -> str:
    """Return a text unchanged; the firmware does not convert other values to text.

    Raises:
        TypeError: the value is not a text.
    """
    if not isinstance(value, str):
        raise TypeError(f"can't convert '{type(value).__name__}' object to str implicitly")
    return value
