"""A shorter way from the genuine library to the devices, without their files, and its waits for motors.

Attributes are read and written hundreds of times in a simulated second; everything else goes through the files.
"""

from __future__ import annotations

import inspect
import select
import types
from collections.abc import Callable, Iterator
from fnmatch import fnmatch
from functools import wraps
from typing import Any

from tuisim.engine.core.profile import MS, MotorLaw
from tuisim.engine.shim.device_files import DeviceFiles, free_of_charge
from tuisim.engine.shim.ev3dev.browser_library import speak_as_browser
from tuisim.engine.shim.plugs import PART_OF_KIND, Plugs, find_port
from tuisim.engine.shim.session import DeviceSession
from tuisim.engine.shim.unsupported.devices import other_sensors_note, refused_device
from tuisim.engine.shim.waits import Wait, waits_for


class Patience:
    """A record of whether the library calls `poll` only to wait until a motor has stopped.

    The arguments of `poll` do not tell for what the library waits.
    """

    def __init__(self) -> None:
        self.until_motors_stop = 0
        """The number of calls of `wait_until_not_moving` without a timeout that are under way."""

    def patient(self, function: Callable[..., bool]) -> Callable[..., bool]:
        """Return a wrapper of `wait_until_not_moving` that marks its polls as waits for motors to stop."""

        @wraps(function)
        def wait_until_not_moving(motor: Any, timeout: float | None = None) -> bool:
            if timeout is not None:
                # With a timeout the library also checks the time after each poll, so the polls must stay short.
                return function(motor, timeout)
            self.until_motors_stop += 1
            try:
                return function(motor)
            finally:
                self.until_motors_stop -= 1

        return wait_until_not_moving


class MotorPoll:
    """The replacement of `select.poll` in the library: it waits in simulated time until a motor ends a move."""

    def __init__(self, session: DeviceSession, patience: Patience) -> None:
        self._session = session
        self._patience = patience

    def register(self, _file: object, _events: int = 0) -> None:
        """Do nothing: any motor that changes ends the wait, and the library checks its own motor again."""

    @waits_for(Wait.MOTOR)
    def poll(self, timeout_ms: float | None = None) -> list[Any]:
        """Block until a motor ends a move or the timeout is over; return an empty list.

        `timeout_ms` is in simulated time; None waits for a second.
        """
        timeout_ns = int((1000 if timeout_ms is None else timeout_ms) * MS)
        sim = self._session.sim
        # A running motor with target speed 0 never ends its move: only repeated polls show that it is stalled.
        target_zero = any(motor.mode and not motor.aim_dps for motor in sim.motors)
        patient = self._patience.until_motors_stop > 0 and not (target_zero or sim.notices)
        self._session.wait_for_motor(timeout_ns, again=patient)
        return []


def connect(
    session: DeviceSession, brick: DeviceFiles, plugs: Plugs, hint: Callable[[str], str]
) -> None:
    """Patch `ev3dev2` before any of its submodules is imported, so that it uses the simulated devices.

    Args:
        session: The run.
        brick: The devices.
        plugs: Adds a missing device to the robot.
        hint: Returns a hint for the error about a missing device, given the device's class.
    """
    import ev3dev2

    plugs.missing = ev3dev2.DeviceNotFound
    ev3dev2.list_device_names = _in_place_of(ev3dev2.list_device_names, _device_lister(brick))
    _patch_device(ev3dev2.Device, brick)
    _charge_memory(ev3dev2.Device, session)
    _patch_look_up(ev3dev2, plugs, hint)


def _in_place_of(
    original: Callable[..., Any], replacement: Callable[..., Any]
) -> Callable[..., Any]:
    """Return a copy of `replacement` with the name and signature of `original`."""
    code: Any = replacement
    copy = types.FunctionType(
        code.__code__, code.__globals__, original.__name__, None, code.__closure__
    )
    return wraps(original)(copy)


def _patch_look_up(library: Any, plugs: Plugs, hint: Callable[[str], str]) -> None:
    look_up = library.Device.__init__

    @wraps(look_up)
    def __init__(self: Any, class_name: str, *args: Any, **kwargs: Any) -> None:  # noqa: N807
        try:
            look_up(self, class_name, *args, **kwargs)
        except library.DeviceNotFound as error:
            refused = refused_device(self, class_name, library.DeviceNotFound)
            if refused is not None:
                raise refused from None
            if plugs.add_device(class_name, self.kwargs):
                look_up(self, class_name, *args, **kwargs)
                plugs.take_hold(self._path)
                return
            error.args = (
                " ".join(
                    filter(
                        None, (str(error), hint(class_name), other_sensors_note(self, class_name))
                    )
                ),
            )
            raise
        plugs.take_hold(self._path)

    library.Device.__init__ = __init__


def _device_lister(brick: DeviceFiles) -> Callable[..., Iterator[str]]:
    def list_device_names(
        class_path: str, name_pattern: str, **wanted: str | list[str]
    ) -> Iterator[str]:
        for name in brick.names(class_path):
            readers = brick.by_path[f"{class_path}/{name}"].readers
            if fnmatch(name, name_pattern) and all(
                key in readers and _matches(str(readers[key]()), pattern)
                for key, pattern in wanted.items()
            ):
                yield name

    return list_device_names


def _matches(value: str, pattern: str | list[str]) -> bool:
    # The library matches substrings, so that both outA and ev3-ports:outA find the port.
    return any(part in value for part in pattern) if isinstance(pattern, list) else pattern in value


def _patch_device(device_class: Any, brick: DeviceFiles) -> None:
    devices = brick.by_path

    def getter(convert: Callable[[Any], object]) -> Callable[..., tuple[Any, object]]:
        def get(self: Any, attribute: Any, name: str) -> tuple[Any, object]:
            try:
                value = devices[self._path].read(name)
            except OSError as error:
                self._raise_friendly_access_error(error, name, None)
            return attribute, convert(value)

        return get

    def set_attribute(self: Any, attribute: Any, name: str, value: Any) -> Any:
        try:
            devices[self._path].writers[name](
                value if isinstance(value, str) else value.decode("latin-1")
            )
        except OSError as error:
            self._raise_friendly_access_error(error, name, value)
        return attribute

    def set_attr_int(self: Any, attribute: Any, name: str, value: Any) -> Any:
        number = int(value)
        try:
            devices[self._path].number_writers[name](number)
        except OSError as error:
            self._raise_friendly_access_error(error, name, str(number))
        return attribute

    for replacement, names in (
        (getter(int), ("get_attr_int",)),
        (set_attr_int, ("set_attr_int",)),
        (getter(str), ("get_attr_string", "get_attr_line", "_get_attribute")),
        (set_attribute, ("_set_attribute", "set_attr_string", "set_attr_raw")),
    ):
        for name in names:
            setattr(device_class, name, _in_place_of(getattr(device_class, name), replacement))


def _charge_memory(device_class: Any, session: DeviceSession) -> None:
    """Let simulated time pass when the library returns an attribute's value from its cache.

    It is the time that the library's own code takes for this. Nothing changes if the profile gives no such time.

    Args:
        device_class: The library's class of devices.
        session: The run.
    """
    cost_ns = session.sim.spec.profile.cached_read_ns
    if not cost_ns:
        return

    def charged(get: Callable[..., Any]) -> Callable[..., Any]:
        def get_cached(self: Any, attribute: Any, name: str) -> Any:
            if name in self._attr_cache:
                session.charge(cost_ns)
            return get(self, attribute, name)

        return _in_place_of(get, get_cached)

    for name in ("get_cached_attr_int", "get_cached_attr_string", "get_cached_attr_set"):
        setattr(device_class, name, charged(getattr(device_class, name)))


def _set_directly(motor_class: Any, brick: DeviceFiles) -> None:
    """Replace the setters of a motor's `speed_sp` and `command` by faster ones, because control loops call these most.

    Args:
        motor_class: The library's class of motors.
        brick: The devices.
    """
    devices = brick.by_path

    def set_speed(self: Any, value: Any) -> None:
        number = int(value)
        try:
            devices[self._path].number_writers["speed_sp"](number)
        except OSError as error:
            self._raise_friendly_access_error(error, "speed_sp", str(number))

    def give_command(self: Any, text: Any) -> None:
        try:
            devices[self._path].writers["command"](
                text if isinstance(text, str) else text.decode("latin-1")
            )
        except OSError as error:
            self._raise_friendly_access_error(error, "command", text)

    motor_class.speed_sp = motor_class.speed_sp.setter(set_speed)
    motor_class.command = motor_class.command.setter(give_command)


def patch_motor_module(
    session: DeviceSession, module: types.ModuleType, brick: DeviceFiles, plugs: Plugs
) -> None:
    """Patch `ev3dev2.motor` after its import, so that its waits and its setters use simulated time and devices."""
    motor: Any = module
    _set_directly(motor.Motor, brick)
    patience = Patience()
    motor.select = types.SimpleNamespace(
        poll=lambda: MotorPoll(session, patience), POLLPRI=select.POLLPRI
    )
    motor.Motor.wait_until_not_moving = patience.patient(motor.Motor.wait_until_not_moving)
    motor.Motor.__init__ = free_of_charge(session, motor.Motor.__init__)
    motor.Motor.wait = free_of_charge(session, motor.Motor.wait)
    _patch_tank(motor, plugs)
    if session.sim.spec.profile.motor_law == MotorLaw.NBEV3DEVSIM:
        speak_as_browser(session, motor, brick)


def _patch_tank(motor: Any, plugs: Plugs) -> None:
    """Patch `MoveTank` so that its motors become the robot's wheels if they have to be plugged in."""
    make = motor.MoveTank.__init__
    signature = inspect.signature(make)

    @wraps(make)
    def __init__(self: Any, *args: Any, **named: Any) -> None:  # noqa: N807
        given = signature.bind(self, *args, **named)
        given.apply_defaults()
        left, right = (
            find_port(given.arguments[f"{side}_motor_port"]) for side in ("left", "right")
        )
        is_medium = motor.MediumMotor in getattr(given.arguments["motor_class"], "__mro__", ())
        plugs.make_wheels(left, right, PART_OF_KIND["medium" if is_medium else "large"])
        make(self, *args, **named)

    motor.MoveTank.__init__ = __init__


def refuse_values(sensor: Any, plugs: Plugs) -> None:
    """Patch the method `value` of a class of sensors, so that reading a value that no mode has raises NotSimulated."""
    read = sensor.value

    @wraps(read)
    def value(self: Any, n: int = 0) -> Any:
        try:
            return read(self, n)
        except Exception:  # the library raises errors of several classes
            if (refused := plugs.refuse_value(self._path, int(n))) is not None:
                raise refused from None
            raise

    sensor.value = value


def patch_sensor_module(
    session: DeviceSession, module: types.ModuleType, brick: DeviceFiles, plugs: Plugs
) -> None:
    """Patch `ev3dev2.sensor` after its import: the library's own checks of the mode take no simulated time."""
    devices = brick.by_path
    sensor: Any = module

    def ensure_mode(self: Any, mode: str) -> None:
        device = devices[self._path]
        if device.readers["mode"]() != mode:
            self.mode = mode

    sensor.Sensor._ensure_mode = ensure_mode
    refuse_values(sensor.Sensor, plugs)
    sensor.Sensor._scale = free_of_charge(session, sensor.Sensor._scale)
