"""Differences between the library of the browser simulator and the genuine one: set points, waiting, motors.

Everything else comes from the genuine library. Numbers have the browser's form: `position`
and `speed` with all their digits, `time_sp` in seconds, `state` '' or 'running'.
"""

from __future__ import annotations

import math
from collections import OrderedDict
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from tuisim.engine.core.profile import MS
from tuisim.engine.shim.device_files import DeviceFiles
from tuisim.engine.shim.session import DeviceSession
from tuisim.engine.shim.waits import Wait, waits_for

POLL_MS = 10
"""Simulated ms between two looks at a motor by a thread that waits for the motor."""


def round_half_up(number: float) -> int:
    """Return the nearest integer; halves are rounded up."""
    return math.floor(number + 0.5)


def speak_as_browser(session: DeviceSession, motor: Any, brick: DeviceFiles) -> None:
    """Patch `ev3dev2.motor` after its import so that it works like the library of the browser simulator.

    Args:
        session: The run.
        motor: The module.
        brick: The devices.
    """
    _patch_properties(motor.Motor, brick)
    motor.Motor.wait = _wait(session, motor.__name__)
    _patch_moves(motor)
    _patch_sets(motor)
    _patch_pairs(motor)
    make = motor.Motor.__init__

    def __init__(self: Any, *args: Any, **named: Any) -> None:  # noqa: N807
        make(self, *args, **named)
        # The browser simulator computes an integer quotient here, without its fraction.
        self.max_rps = float(self.max_speed // self.count_per_rot)
        self.max_rpm, self.max_dps = self.max_rps * 60, self.max_rps * 360
        self.max_dpm = self.max_rpm * 360

    motor.Motor.__init__ = __init__


def _patch_properties(motor_class: Any, brick: DeviceFiles) -> None:
    devices = brick.by_path

    def reader(name: str) -> Callable[[Any], object]:
        return lambda self: devices[self._path].read(name)

    def set_time(self: Any, seconds: float) -> None:
        devices[self._path].write("time_sp", repr(float(seconds)))

    motor_class.position = motor_class.position.getter(reader("position"))
    motor_class.speed = property(reader("speed"))
    motor_class.state = property(reader("state"))
    motor_class.time_sp = property(reader("time_sp"), set_time)


def _wait(session: DeviceSession, library: str) -> Callable[..., bool]:
    look_ns = POLL_MS * MS

    def now_s() -> float:
        return session.now / MS / 1000

    def sleep_until_motor_ends() -> None:
        """Sleep until the first poll after a motor ends a move; with other threads, only until the next poll."""
        begun = session.now
        session.wait_for_motor(look_ns, again=True)
        if rest_ns := (begun - session.now) % look_ns:
            session.spend(rest_ns)
        elif session.now == begun:
            session.spend(look_ns)

    @waits_for(Wait.MOTOR)
    def wait(self: Any, cond: Callable[[str], bool], timeout: float | None = None) -> bool:
        """Poll until `cond(self.state)` is true or the timeout in milliseconds is over; return whether it is true."""
        deadline_s = now_s() + (timeout or 0) / 1000
        # The result of the library's own conditions changes only when a motor ends a move.
        only_state = timeout is None and getattr(cond, "__module__", "") == library
        while True:
            if only_state and not cond(self.state):
                sleep_until_motor_ends()
            else:
                session.spend(look_ns)
            if cond(self.state):
                return True
            if timeout is not None and now_s() >= deadline_s:
                return False

    return wait


def _start(
    motor: Any, motors: Sequence[Any], command: str, brake: bool | None, block: bool
) -> None:
    """Give motors a command.

    Args:
        motor: The module.
        motors: The motors.
        command: The name of the method that gives the command.
        brake: Whether the stop action is `hold`; otherwise it is `coast`; None: it stays as it is.
        block: Whether to wait until the motors have stopped.
    """
    for one in motors if brake is not None else ():
        one._set_brake(brake)
    for one in motors:
        getattr(one, command)()
    if block:
        for one in motors:
            one.wait_until("running", timeout=motor.WAIT_RUNNING_TIMEOUT)
            one.wait_until_not_moving()


def _patch_moves(motor: Any) -> None:
    def on_for_degrees(
        self: Any, speed: Any, degrees: float, brake: bool = True, block: bool = True
    ) -> None:
        """Rotate the motor by an angle at a speed; a negative speed changes the direction.

        Args:
            speed: In percent, or an object such as `SpeedDPS`.
            degrees: The angle; a negative one also changes the direction.
            brake: Whether the stop action is `hold`; otherwise it is `coast`.
            block: Whether the call returns only when the motor has stopped.
        """
        native = self._speed_native_units(speed)
        if isinstance(speed, motor.SpeedValue):
            # Halves are rounded up before the sign is removed, as in the browser simulator.
            native = round_half_up(native)
        self.position_sp = round_half_up(-degrees if native < 0 else degrees)
        self.speed_sp = round_half_up(abs(native))
        _start(motor, [self], "run_to_rel_pos", brake, block)

    def on_for_rotations(
        self: Any, speed: Any, rotations: float, brake: bool = True, block: bool = True
    ) -> None:
        """Rotate the motor by a number of rotations at a speed; a negative speed changes the direction.

        Args:
            speed: In percent, or an object such as `SpeedDPS`.
            rotations: The number; a negative one also changes the direction.
            brake: Whether the stop action is `hold`; otherwise it is `coast`.
            block: Whether the call returns only when the motor has stopped.
        """
        self.on_for_degrees(speed, rotations * 360, brake, block)

    def on_for_seconds(
        self: Any, speed: Any, seconds: float, brake: bool = True, block: bool = True
    ) -> None:
        """Rotate the motor for some time at a speed.

        Args:
            speed: In percent, or an object such as `SpeedDPS`.
            seconds: The time.
            brake: Whether the stop action is `hold`; otherwise it is `coast`.
            block: Whether the call returns only when the motor has stopped.
        """
        _refuse_negative(seconds)
        self.speed_sp, self.time_sp = round_half_up(self._speed_native_units(speed)), seconds
        _start(motor, [self], "run_timed", brake, block)

    def on(self: Any, speed: Any, brake: bool = True, block: bool = False) -> None:
        """Rotate the motor at a speed until the next command.

        Args:
            speed: In percent, or an object such as `SpeedDPS`.
            brake: Whether the stop action is `hold`; otherwise it is `coast`.
            block: Whether the call returns only when the motor has stopped.
        """
        self.speed_sp = round_half_up(self._speed_native_units(speed))
        _start(motor, [self], "run_forever", brake, block)

    def on_to_position(
        self: Any, speed: Any, position: float, brake: bool = True, block: bool = True
    ) -> None:
        """Rotate the motor to a position at a speed.

        Args:
            speed: In percent, or an object such as `SpeedDPS`.
            position: The position in degrees.
            brake: Whether the stop action is `hold`; otherwise it is `coast`.
            block: Whether the call returns only when the motor has stopped.
        """
        self.speed_sp, self.position_sp = round_half_up(self._speed_native_units(speed)), position
        _start(motor, [self], "run_to_abs_pos", brake, block)

    for method in (on, on_for_degrees, on_for_rotations, on_for_seconds, on_to_position):
        setattr(motor.Motor, method.__name__, method)


def _refuse_negative(seconds: float) -> None:
    if seconds < 0:
        raise ValueError(f"seconds is negative ({seconds})")


def _patch_sets(motor: Any) -> None:
    def __init__(self: Any, motor_specs: Mapping[str, Any], desc: str | None = None) -> None:  # noqa: N807
        # The library waits for the motors one after another, in this order.
        self.motors = OrderedDict(
            (port, motor_class(port)) for port, motor_class in motor_specs.items()
        )
        self.desc = desc
        self.reset()

    motor.MotorSet.__init__ = __init__


def _patch_pairs(motor: Any) -> None:
    def motors_of(pair: Any) -> tuple[Any, Any]:
        return pair.left_motor, pair.right_motor

    def on_for_degrees(
        self: Any,
        left_speed: Any,
        right_speed: Any,
        degrees: float,
        brake: bool = True,
        block: bool = True,
    ) -> None:
        """Rotate the faster motor of a pair by `degrees`; the slower one turns proportionally less.

        Args:
            left_speed, right_speed: In percent, or objects such as `SpeedDPS`; a negative one turns backwards.
            degrees: The angle of the faster motor.
            brake: Whether the stop action is `hold`; otherwise it is `coast`.
            block: Whether the call returns only when the motors have stopped.
        """
        speeds = [
            round_half_up(speed)
            for speed in self._unpack_speeds_to_native_units(left_speed, right_speed)
        ]
        fastest = max(map(abs, speeds))
        for one, speed in zip(motors_of(self), speeds, strict=True):
            part = round_half_up(
                degrees if abs(speed) == fastest else abs(speed / fastest) * degrees
            )
            one.position_sp, one.speed_sp = -part if speed < 0 else part, abs(speed)
        _start(motor, motors_of(self), "run_to_rel_pos", brake, block)

    def on_for_seconds(
        self: Any,
        left_speed: Any,
        right_speed: Any,
        seconds: float,
        brake: bool = True,
        block: bool = True,
    ) -> None:
        """Rotate both motors of a pair for some time, each at its own speed.

        Args:
            left_speed, right_speed: In percent, or objects such as `SpeedDPS`; a negative one turns backwards.
            seconds: The time.
            brake: Whether the stop action is `hold`; otherwise it is `coast`.
            block: Whether the call returns only when the motors have stopped.
        """
        _refuse_negative(seconds)
        speeds = self._unpack_speeds_to_native_units(left_speed, right_speed)
        for one, speed in zip(motors_of(self), speeds, strict=True):
            one.speed_sp, one.time_sp = round_half_up(speed), seconds
        _start(motor, motors_of(self), "run_timed", brake, block)

    def on(self: Any, left_speed: Any, right_speed: Any) -> None:
        """Rotate both motors of a pair until the next command, each at its own speed.

        Args:
            left_speed, right_speed: In percent, or objects such as `SpeedDPS`; a negative one turns backwards.
        """
        speeds = self._unpack_speeds_to_native_units(left_speed, right_speed)
        for one, speed in zip(motors_of(self), speeds, strict=True):
            one.speed_sp = round_half_up(speed)
        _start(motor, motors_of(self), "run_forever", None, False)

    for method in (on, on_for_degrees, on_for_seconds):
        setattr(motor.MoveTank, method.__name__, method)
