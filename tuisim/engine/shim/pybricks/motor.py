"""`Motor` of `pybricks.ev3devices`, its `control`, and `DCMotor` of `pybricks.iodevices`."""

from __future__ import annotations

import errno
from collections.abc import Mapping, Sequence
from enum import Enum
from typing import Any, ClassVar

from tuisim.engine.core.commands.calls import Call
from tuisim.engine.core.commands.servo import SETTINGS
from tuisim.engine.core.servo.control import BRAKING, Controller, Ending
from tuisim.engine.core.servo.motor import ServoMotor
from tuisim.engine.core.servo.settings import FULL_ACTUATION
from tuisim.engine.core.servo.trajectory import MAX_DURATION_US, MILLI, MS_US
from tuisim.engine.shim.brick import MOTOR_CLASS
from tuisim.engine.shim.pybricks.brick import (
    Connected,
    Waiting,
    invalid_argument,
    no_device,
    not_permitted,
    whole,
)
from tuisim.engine.shim.pybricks.parameters import Direction, Port, Stop
from tuisim.engine.shim.pybricks.unsimulated import LOGGER
from tuisim.engine.shim.unsupported.modules import refused_part

PERCENT = FULL_ACTUATION // 100
FACTORS: Mapping[str, int] = {
    **dict.fromkeys(("kp", "ki", "kd", "stall_time_ms"), 1),
    "torque_unm": 1000,
    **dict.fromkeys(("actuation", "feed_forward"), PERCENT),
}
"""For each setting of a controller that is not in counts, the factor from the number that a program gives to the one
that the controller stores.
"""


def gear_ratio(gears: Any) -> float:
    """Return how many turns a motor makes for one turn of the part that it drives.

    Args:
        gears: None for no gears, the numbers of teeth of one gear train, such as `[12, 36]`, or a list of gear trains.

    Raises:
        TypeError, ValueError: `gears` has another form, or a gear has no teeth.
    """
    if gears is None:
        return 1.0
    trains = gears if gears and isinstance(gears[0], Sequence) else [gears]
    ratio = 1.0
    for train in trains:
        if len(train) < 2 or whole(train[0]) <= 0 or whole(train[-1]) <= 0:
            raise invalid_argument()
        ratio *= whole(train[-1]) / whole(train[0])
    return ratio


def ending_of(stops: tuple[type[Enum], ...], then: Any) -> Ending:
    """Return what a motor does after a move, given as a member of the library's enumeration `Stop`.

    Args:
        stops: The enumerations `Stop` of all versions that the program may use.
        then: The member.

    Raises:
        TypeError: `then` is not a member of any of them.
    """
    if not isinstance(then, stops):
        raise TypeError(f"a Stop is needed, not {then!r}")
    return Ending(then.value)


class DCMotor(Connected):
    """A motor that runs with a given power: nothing controls its speed or its angle."""

    def __init__(self, port: Port, positive_direction: Direction = Direction.CLOCKWISE) -> None:
        self._set_up(port, positive_direction, 1.0)

    def _set_up(
        self, port: Port, direction: Direction, ratio: float, *, keeps_angle: bool = False
    ) -> None:
        name = self._take_port(port, self.brick.session.sim.spec.robot.output_ports)
        self.port_names = (name,)
        found = self.brick.find_motor(name)
        if found is None:
            raise no_device(self.brick.hint(MOTOR_CLASS))
        self.simulated: ServoMotor = found
        """The motor of the simulation that this object controls."""
        self.tell(Call.SET_UP, float(direction.sign), ratio, float(keeps_angle))

    def tell(self, call: Call, *values: float | None) -> None:
        """Give a command with its values to the simulated motor; None stands for a value that is not given."""
        self.brick.tell(self.brick.session.sim.find_number(self.simulated), call, *values)

    def _command(self) -> None:
        """Count a command to the motor (see `DeviceSession.command`), and check that no drive base uses the motor.

        Raises:
            OSError: a drive base moves or holds the motor.
        """
        self.brick.command()
        if self.simulated.follows_base:
            raise not_permitted()

    def _run_freely(self, actuation: int | None) -> None:
        self._command()
        self.tell(Call.RUN_FREELY, actuation)

    def dc(self, duty: float) -> None:
        """Run the motor at a power in percent, without control of its speed."""
        self._run_freely(max(-100, min(100, whole(duty))) * PERCENT)

    def stop(self) -> None:
        """Let the motor coast."""
        self._run_freely(None)

    def brake(self) -> None:
        """Brake the motor, without holding its angle afterwards."""
        self._run_freely(0)


class Motor(DCMotor):
    """A large or medium motor, whose speed and angle are controlled."""

    STOPS: ClassVar[tuple[type[Enum], ...]] = (Stop,)
    """The `Stop` classes whose members a move accepts as its argument `then`, what the motor does afterwards."""
    log = refused_part("Motor", "log", LOGGER)

    def __init__(
        self, port: Port, positive_direction: Direction = Direction.CLOCKWISE, gears: Any = None
    ) -> None:
        self._set_up(port, positive_direction, gear_ratio(gears))
        self.control = Control(self, self.simulated.control)

    # Readings

    def angle(self) -> int:
        """Return the motor's angle in degrees."""
        now_us = self.brick.read("position", *self.port_names)
        return self.simulated.control.settings.units(
            round(self.simulated.find_milli(now_us) / MILLI)
        )

    def speed(self) -> int:
        """Return the motor's speed in degrees per second."""
        now_us = self.brick.read("speed", *self.port_names)
        return self.simulated.control.settings.units(self.simulated.find_counts_per_s(now_us))

    def reset_angle(self, angle: float | None = None) -> None:
        """Make the motor show the angle `angle`, in degrees, at its present position; a motion under way ends.

        Raises:
            OSError: the angle is None, because the EV3's motors do not know their absolute angle.
        """
        if angle is None:
            raise OSError(
                errno.EOPNOTSUPP,
                "EOPNOTSUPP: the EV3's motors have no absolute encoder; give an angle",
            )
        self._command()
        self.tell(Call.SET_MILLI, self.simulated.control.settings.counts(whole(angle)) * MILLI)

    # Motions that only another command ends

    def hold(self) -> None:
        """Stop the motor, and hold its angle."""
        self._command()
        self.tell(Call.HOLD)
        self._follow()

    def run(self, speed: float) -> None:
        """Run the motor at a speed in degrees per second, until the next command."""
        self._command()
        settings = self.simulated.control.settings
        rate = settings.counts(whole(speed))
        self.tell(Call.RUN_AT, rate, settings.acceleration, None, Ending.HOLD)

    def _follow(self, ending: Ending = Ending.HOLD) -> None:
        self.tell(Call.FOLLOW, ending)

    def track_target(self, target_angle: float) -> None:
        """Turn the motor to an angle as fast as possible, and hold it there."""
        self._command()
        counts = self.simulated.control.settings.counts(whole(target_angle))
        self.tell(Call.HOLD_MILLI, counts * MILLI)
        self._follow()

    # Moves

    def run_time(
        self, speed: float, time: float, then: Stop = Stop.HOLD, wait: bool = True
    ) -> None:
        """Run the motor at a speed in degrees per second for `time` ms.

        Args:
            speed: The speed.
            time: How long the motor runs.
            then: What the motor does afterwards.
            wait: Whether the call blocks until the move is over.
        """
        self._command()
        settings = self.simulated.control.settings
        time_us = whole(time) * MS_US
        if not 0 <= time_us <= MAX_DURATION_US:
            raise invalid_argument()
        rate = settings.counts(whole(speed))
        self.tell(Call.RUN_AT, rate, settings.acceleration, time_us, None)
        return self._begin(then, wait, "run_time()")

    def run_angle(
        self, speed: float, rotation_angle: float, then: Stop = Stop.HOLD, wait: bool = True
    ) -> None:
        """Turn the motor by an angle in degrees.

        Args:
            speed: The speed in degrees per second; a negative one changes the direction.
            rotation_angle: The angle.
            then: What the motor does afterwards.
            wait: Whether the call blocks until the move is over.
        """
        speed = whole(speed)
        angle = whole(rotation_angle)
        return self._move(
            speed, angle if speed >= 0 else -angle, then, wait, "run_angle()", relative=True
        )

    def run_target(
        self, speed: float, target_angle: float, then: Stop = Stop.HOLD, wait: bool = True
    ) -> None:
        """Turn the motor to an angle in degrees.

        Args:
            speed: The speed in degrees per second; its sign is ignored.
            target_angle: The angle.
            then: What the motor does afterwards.
            wait: Whether the call blocks until the move is over.
        """
        return self._move(
            whole(speed), whole(target_angle), then, wait, "run_target()", relative=False
        )

    def _move(
        self, speed: int, angle: int, then: Stop, wait: bool, call: str, *, relative: bool
    ) -> None:
        self._command()
        settings = self.simulated.control.settings
        try:
            self.tell(
                Call.MOVE,
                settings.counts(angle),
                settings.counts(speed),
                settings.acceleration,
                relative,
            )
        except ValueError:
            raise invalid_argument() from None
        return self._begin(then, wait, call)

    def _begin(self, then: Stop, wait: bool, call: str) -> None:
        motor = self.simulated
        self._follow(ending_of(self.STOPS, then))
        if wait:
            waiting = self.brick.until_done(lambda now_us: self._done(now_us, call), motor.control)
            return self.brick.finish(waiting, self.stop)
        return None

    def _done(self, now_us: int, call: str) -> bool:
        """Return whether the motor's move is over; print a message once if something blocks the motor.

        Args:
            now_us: The present time.
            call: The call that waits for the end of the move, for the message.
        """
        motor = self.simulated
        if motor.guide is None:
            return True
        if motor.control.stalled and not motor.control.timed:
            self.brick.say_stalled(f"the motor on {self.port_names[0]} is", call)
        return self.move_done(now_us, motor.control)

    def change_setting(self, _control: Controller, setting: int, value: int) -> None:
        """Change a setting of the motor's controller.

        Args:
            setting: The number of the setting.
            value: Its new value, in the units of the controller, which are called counts.
        """
        self.tell(Call.SET_CONTROL, setting, value)

    def has_let_go(self) -> bool:
        """Return whether the motor's move is over, and the motor coasts or brakes instead of holding."""
        return self.simulated.lets_go and self.move_done(self.brick.now_us, self.simulated.control)

    def move_done(self, now_us: int, control: Controller) -> bool:
        """Return whether no move of a controller of the motor is under way."""
        motor = self.simulated
        rate = motor.find_counts_per_s(now_us, control.settings.speed_window_ms)
        return control.done(now_us, motor.find_milli(now_us), rate)

    def run_until_stalled(
        self, speed: float, then: Stop = Stop.COAST, duty_limit: float | None = None
    ) -> int:
        """Run the motor at a speed until something blocks it, and return the angle in degrees that it has then.

        Args:
            speed: In degrees per second.
            then: What the motor does afterwards.
            duty_limit: The highest power in percent; None for no limit.
        """
        limit = None if duty_limit is None else max(0, min(100, whole(duty_limit))) * PERCENT
        self.run(speed)
        self.tell(Call.LIMIT_DUTY, limit)
        self._follow()
        return self.brick.finish(self._until_stalled(then), self.stop)

    def _until_stalled(self, then: Stop) -> Waiting[int]:
        motor = self.simulated
        yield from self.brick.until_done(
            lambda _: motor.guide is None or motor.control.stalled, motor.control
        )
        angle = self.angle()
        if motor.control.stalled or not self.brick.in_task:
            self._rest(ending_of(self.STOPS, then))
        return angle

    def _rest(self, ending: Ending) -> None:
        if ending is Ending.HOLD:
            self.hold()
        else:
            self._run_freely(0 if ending in BRAKING else None)


class Control(Connected):
    """The settings of a motor's or drive base's controller, as a program reads and sets them.

    Args:
        owner: The motor or drive base of the controller.
        control: The controller.
    """

    SETTINGS_WHILE_ACTIVE: ClassVar[bool] = False

    def __init__(self, owner: Any, control: Controller) -> None:
        self._owner = owner
        self._control = control

    @property
    def scale(self) -> float:
        """How many counts, the units in which the controller measures, there are in a degree.

        For the distance of a drive base, it is the number of counts in a mm.
        """
        return self._control.settings.counts_per_unit

    def _access(self, **values: float | None) -> tuple[int, ...] | None:
        """Set those settings whose values are not None; if all are None, return the settings in the program's units.

        Raises:
            OSError: a move is under way, or the motor holds.
        """
        settings = self._control.settings
        given = {name: whole(value) for name, value in values.items() if value is not None}
        if not given:
            return tuple(
                getattr(settings, name) // FACTORS[name]
                if name in FACTORS
                else settings.tell(getattr(settings, name))
                for name in values
            )
        is_active = self._control.trajectory is not None and not self._owner.has_let_go()
        if is_active and not self.SETTINGS_WHILE_ACTIVE:
            raise not_permitted()
        if any(value < 0 for value in given.values()):
            raise invalid_argument()
        for name, value in given.items():
            number = value * FACTORS[name] if name in FACTORS else settings.take(value)
            self._owner.change_setting(self._control, SETTINGS.index(name), number)
        return None

    def limits(
        self,
        speed: float | None = None,
        acceleration: float | None = None,
        actuation: float | None = None,
    ) -> tuple[int, ...] | None:
        """Set the highest speed, acceleration and power, and return None; without arguments, return all three.

        The speed is in °/s, the acceleration in °/s², the power in percent. For the distance of a drive base, the speed
        is in mm/s, and the acceleration in mm/s².
        """
        if any(
            value is not None and whole(value) < 1 for value in (speed, acceleration, actuation)
        ):
            raise invalid_argument()
        return self._access(speed=speed, acceleration=acceleration, actuation=actuation)

    def pid(
        self,
        kp: float | None = None,
        ki: float | None = None,
        kd: float | None = None,
        integral_range: float | None = None,
        integral_rate: float | None = None,
        feed_forward: float | None = None,
    ) -> tuple[int, ...] | None:
        """Set the gains of the controller; without arguments, return them. Only `kp` changes a simulated motion."""
        return self._access(
            kp=kp,
            ki=ki,
            kd=kd,
            integral_range=integral_range,
            integral_rate=integral_rate,
            feed_forward=feed_forward,
        )

    def target_tolerances(
        self, speed: float | None = None, position: float | None = None
    ) -> tuple[int, ...] | None:
        """Set by how much speed and position may differ from their targets at the end of a move, and return None.

        Without arguments, return the two differences. They are in degrees per second and degrees; for the distance of a
        drive base, in mm/s and mm.
        """
        return self._access(speed_tolerance=speed, position_tolerance=position)

    def stall_tolerances(
        self, speed: float | None = None, time: float | None = None
    ) -> tuple[int, ...] | None:
        """Set when a motor counts as stalled, and return None; without arguments, return the two settings.

        Args:
            speed: The motor must be slower than this, in degrees per second; for the distance of a drive base, in mm/s.
            time: It must be so slow for this time, in ms.
        """
        return self._access(stall_speed=speed, stall_time_ms=time)

    def trajectory(self) -> tuple[int, ...] | None:
        """Return the planned course of the present motion as eleven numbers; None if there is none.

        It has four points: the start, the beginning of the constant speed, the end of the constant speed, and the end.
        The numbers are the times of the points in ms, then their positions in counts (the controller's units), then the
        speed in counts/s, then the acceleration and the deceleration in counts/s².
        """
        trajectory = self._control.trajectory
        if trajectory is None:
            return None
        parts = (trajectory.first, trajectory.even, trajectory.last, trajectory.end)
        return (
            *((part.start_us - parts[0].start_us) // MS_US for part in parts),
            *(part.milli // MILLI for part in parts),
            parts[1].rate,
            parts[0].acceleration,
            parts[2].acceleration,
        )

    def done(self) -> bool:
        """Return whether no move of the controller is under way."""
        return bool(
            self._owner.move_done(self.brick.read("state", *self._owner.port_names), self._control)
        )

    def stalled(self) -> bool:
        """Return whether something blocks the controller's motion."""
        self.brick.read("state", *self._owner.port_names)
        return self._control.stalled
