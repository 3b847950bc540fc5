"""Parts that only version 4 of the library has, or has in another form: endings of moves, arcs, tasks.

In a task, which `run_task` runs, a blocking call immediately returns an object that the task awaits.
"""

from __future__ import annotations

from math import atan2, degrees, hypot, radians
from typing import Any

from tuisim.engine.core.commands.calls import Call
from tuisim.engine.core.commands.servo import SETTINGS
from tuisim.engine.core.servo.motor import MAX_WINDOW_MS
from tuisim.engine.core.servo.settings import (
    BATTERY_V,
    COUNTS_PER_DEG,
    FIRMWARES,
    FULL_ACTUATION,
)
from tuisim.engine.core.servo.trajectory import MILLI
from tuisim.engine.shim.pybricks import ev3devices, motor, robotics, tools
from tuisim.engine.shim.pybricks.brick import (
    Connected,
    Waiting,
    build_busy_error,
    invalid_argument,
    refused,
    round_number,
    whole,
)
from tuisim.engine.shim.pybricks.hsv_color import Color as Color
from tuisim.engine.shim.pybricks.motor import PERCENT, gear_ratio
from tuisim.engine.shim.pybricks.parameters import Direction, NamedEnum, Port
from tuisim.engine.shim.pybricks.unsimulated import MODEL
from tuisim.engine.shim.unsupported.modules import refused_part

RANGES = (0, 2000), (50, 20_000)
"""Lowest and highest speed of a motor in °/s that a setting accepts, even if no motor is so fast, then the same for the
acceleration in °/s².
"""
STALLED_TICKS = 25
"""A motor that runs at a power counts as stalled after something has blocked it for this many ticks, 250 ms."""
MIN_PROFILE_DEG = 5
"""The smallest tolerance of a motor's position in degrees; a smaller argument `profile` counts as this."""
MIN_RADIUS_MM = 10
"""Smallest radius in mm of an arc; a smaller one is an error."""


class Stop(NamedEnum):
    """What a motor does after a move, under version 4 of Pybricks, which has more choices than version 2.0."""

    COAST, BRAKE, HOLD, NONE, COAST_SMART, BRAKE_SMART = range(6)


class Motor(motor.Motor):
    """A motor under version 4 of Pybricks, which has more methods than under 2.0, such as `done` and `settings`."""

    STOPS = (*motor.Motor.STOPS, Stop)
    model = refused_part("Motor", "model", MODEL)

    def __init__(
        self,
        port: Port,
        positive_direction: Direction = Direction.CLOCKWISE,
        gears: Any = None,
        reset_angle: bool = True,
        profile: int | None = None,
    ) -> None:
        self._set_up(port, positive_direction, gear_ratio(gears), keeps_angle=not reset_angle)
        self.control = Control(self, self.simulated.control)
        motor = self.simulated
        kind = FIRMWARES[motor.law].motors[motor.kind]
        self._max_mv = kind.max_mv
        if profile is not None:
            tolerance = max(MIN_PROFILE_DEG, whole(profile))
            self.control.target_tolerances(position=tolerance)
            self.control.pid(*kind.compute_gains(tolerance)[:2])

    def _command(self) -> None:
        """Count a command to the motor (see `DeviceSession.command`).

        If a drive base moves or holds the motor, stop the drive base, so that both its motors coast.
        """
        self.brick.command()
        if self.simulated.follows_base and DriveBase.current is not None:
            DriveBase.current.stop()

    def dc(self, duty: float) -> None:
        """Run the motor at a power in percent, up to its highest voltage, without control of its speed."""
        highest = int(self._max_mv / BATTERY_V / 10)
        super().dc(max(-highest, min(highest, whole(duty))))

    _zero_deg = 0
    """The motor angle in degrees, as `angle` now returns it, of the shaft's mark, where the motor was at the start."""

    def reset_angle(self, angle: float | None = None) -> None:
        """Make the motor show the angle `angle`, in degrees, at its present position.

        By default, it is the angle from the mark on the shaft, which the motor of a hub knows.
        """
        if angle is None and self.brick.session.sim.spec.robot.hub:
            angle = (self.angle() - self._zero_deg + 180) % 360 - 180
        if angle is not None:
            self._zero_deg += whole(angle) - self.angle()
        super().reset_angle(angle)

    def speed(self, window: float = 100) -> int:
        """Return the mean speed over the last `window` milliseconds, in degrees per second."""
        window_ms = whole(window)
        _check_range(window_ms, 1, MAX_WINDOW_MS)
        now_us = self.brick.read("speed", *self.port_names)
        rate = self.simulated.find_counts_per_s(now_us, window_ms)
        return self.simulated.control.settings.tell(rate)

    def done(self) -> bool:
        """Return whether no move of the motor is under way."""
        return self.control.done()

    def stalled(self) -> bool:
        """Return whether something blocks the motor."""
        motor = self.simulated
        is_blocked = motor.blocked_ticks >= STALLED_TICKS and bool(motor.duty)
        return self.control.stalled() or is_blocked

    def load(self) -> int:
        """Return the load on the motor in mNm: always 0 for a simulated motor."""
        self.brick.read()
        return 0

    def settings(self, max_voltage: float | None = None) -> tuple[int] | None:
        """Set the highest voltage in mV, and return None; without an argument, return it in a tuple."""
        if max_voltage is None:
            return (self._max_mv,)
        self._max_mv = whole(max_voltage)
        actuation = int(FULL_ACTUATION * self._max_mv / BATTERY_V / 1000)
        limited = max(PERCENT, min(FULL_ACTUATION, actuation))
        self.change_setting(self.simulated.control, SETTINGS.index("actuation"), limited)
        return None

    def close(self) -> None:
        """Let the motor coast, so that another drive base can use it."""
        self.stop()
        if DriveBase.current is not None and DriveBase.current.has_motor(self):
            robotics.DriveBase.current = None


def _check_range(value: float, lowest: int, highest: int) -> None:
    if not lowest <= value <= highest:
        raise invalid_argument()


class Control(motor.Control):
    """The settings of a controller under version 4 of Pybricks, which may be changed at any time."""

    SETTINGS_WHILE_ACTIVE = True

    def check(self, value: float, kind: int) -> int:
        """Return a speed or an acceleration that the program gives, without its fraction.

        Args:
            value: In °/s or °/s²; for a drive base's distance, in mm/s or mm/s².
            kind: 0 for a speed, 1 for an acceleration.

        Raises:
            ValueError: the firmware does not accept it.
        """
        number = whole(value)
        motor_deg = number * self.scale / COUNTS_PER_DEG / len(self._owner.port_names)
        _check_range(motor_deg, *RANGES[kind])
        return number

    def limits(
        self, speed: float | None = None, acceleration: Any = None, torque: float | None = None
    ) -> tuple[int, ...] | None:
        """Set the highest speed, acceleration and torque, and return None; without arguments, return all three.

        The speed is in °/s, the acceleration in °/s², the torque in mNm. For the distance of a drive base, the speed is
        in mm/s, and the acceleration in mm/s². If the program gives a pair of accelerations, only the first one is
        used.
        """
        if isinstance(acceleration, tuple):
            acceleration = acceleration[0]
        for kind, value in enumerate((speed, acceleration)):
            if value is not None:
                self.check(value, kind)
        return self._access(speed=speed, acceleration=acceleration, torque_unm=torque)

    def pid(  # type: ignore[override]
        self,
        kp: float | None = None,
        ki: float | None = None,
        kd: float | None = None,
        integral_deadzone: float | None = None,
        integral_rate: float | None = None,
    ) -> tuple[int, ...] | None:
        """Set the constants of the PID controller, and return None; without arguments, return all five.

        Args:
            kp: The proportional gain, in µNm per degree.
            ki: The integral gain, in µNm per degree and second.
            kd: The derivative gain, in µNm per degree per second.
            integral_deadzone, integral_rate: The dead zone of the integral, and the highest rate at which it grows.
        """
        gains = super().pid(kp, ki, kd, integral_deadzone, integral_rate)
        return gains and gains[:5]

    def load(self) -> int:
        """Return the load on the motor or drive base in mNm: always 0 in the simulation."""
        self.brick.read()
        return 0


class DriveBase(robotics.DriveBase):
    """A robot with two driven wheels under version 4 of Pybricks. It has more moves than under 2.0, such as `arc`."""

    CONTROL = Control
    MIN_SIZE_MM = 1

    _stops: tuple[int, ...] = ()
    """The decelerations of straight moves and of turns, in mm/s² and °/s²; empty as long as `settings` has set none."""

    def _take_place(self, earlier: robotics.DriveBase) -> None:
        if earlier.has_motor(self.left) or earlier.has_motor(self.right):
            raise build_busy_error()
        super()._take_place(earlier)

    def straight(self, distance: float, then: Stop = Stop.HOLD, wait: bool = True) -> None:
        """Drive a distance in mm.

        Args:
            distance: The distance.
            then: What the motors do afterwards.
            wait: Whether the call blocks until the move is over.
        """
        return self._move(whole(distance), 0, "straight()", then, wait=wait)

    def move_by(self, dx: float, dy: float, then: Stop = Stop.HOLD) -> None:
        """Turn to the direction of a point, and drive there.

        Args:
            dx, dy: The way to the point in mm: `dx` in the direction of heading 0, and `dy` to the left of that
                direction.
            then: What the motors do at the end.
        """
        return self.brick.finish(self._move_by(whole(dx), whole(dy), then), self.stop)

    def _move_by(self, dx: int, dy: int, then: Stop) -> Waiting[None]:
        self.turn(round(-degrees(atan2(dy, dx))), wait=False, absolute=True)
        yield from self._wait_for_end("move_by()")
        self.straight(hypot(dx, dy), then, wait=False)
        yield from self._wait_for_end("move_by()")

    def turn(
        self, angle: float, then: Stop = Stop.HOLD, wait: bool = True, absolute: bool = False
    ) -> None:
        """Turn on the spot.

        Args:
            angle: By how many degrees to turn, clockwise.
            then: What the motors do afterwards.
            wait: Whether the call blocks until the move is over.
            absolute: Whether `angle` is the heading to turn to instead; the shorter way is taken.
        """
        by: float = whole(angle)
        if absolute:
            by = (by - self.angle() + 180) % 360 - 180
        return self._move(0, by, "turn()", then, wait=wait)

    def curve(self, radius: float, angle: float, then: Stop = Stop.HOLD, wait: bool = True) -> None:
        """Drive along an arc.

        Args:
            radius: The radius in mm; a negative one turns in the other direction.
            angle: The angle of the arc in degrees.
            then: What the motors do afterwards.
            wait: Whether the call blocks until the move is over.
        """
        turned = -whole(angle) if radius < 0 else whole(angle)
        way = whole(radius) * radians(abs(whole(angle)))
        return self._move(way, turned, "curve()", then, wait=wait)

    def arc(
        self,
        radius: float,
        angle: float | None = None,
        distance: float | None = None,
        then: Stop = Stop.HOLD,
        wait: bool = True,
    ) -> None:
        """Drive along an arc, whose length is given by an angle or by a distance.

        Args:
            radius: The radius in mm; a negative one turns in the other direction.
            angle: The angle of the arc in degrees; None if `distance` is given.
            distance: The length of the arc in mm; None if `angle` is given.
            then: What the motors do afterwards.
            wait: Whether the call blocks until the move is over.

        Raises:
            ValueError: both or neither of `angle` and `distance` are given, or the radius is too small.
        """
        if (angle is None) == (distance is None):
            raise ValueError("Please specify distance or angle but not both.")
        if abs(whole(radius)) < MIN_RADIUS_MM:
            raise invalid_argument()
        way = whole(distance) if distance is not None else abs(radius) * radians(whole(angle))
        return self._move(way, degrees(way / radius), "arc()", then, wait=wait)

    def angle(self) -> float:  # type: ignore[override]
        """Return the angle in degrees by which the robot has turned clockwise; `reset` sets it."""
        now_us = self._read()
        base = self._base
        counts = base.find_millis(now_us)[1] / MILLI - self._zeros[1]
        return round_number(counts / base.heading.settings.counts_per_unit)

    def use_gyro(self, use_gyro: bool) -> None:
        """Take the heading from the hub's gyro if the argument is True, and from the wheels if it is False.

        If this is a change, the motors coast.
        """
        if not self.brick.session.sim.spec.robot.hub:
            raise refused("the EV3 has no gyro inside")
        if bool(use_gyro) != self._base.uses_gyro:
            self.brick.command()
            self.tell(Call.USE_GYRO, float(bool(use_gyro)))
            self._zeros = self._zeros[0], 0

    def settings(
        self,
        straight_speed: Any = None,
        straight_acceleration: Any = None,
        turn_rate: Any = None,
        turn_acceleration: Any = None,
    ) -> tuple[Any, ...] | None:
        """Set speed and acceleration of straight moves and of turns; without arguments, return these four.

        They are in mm/s, mm/s², °/s and °/s². An acceleration may be a pair: for the start and for the stop.
        """
        values = straight_speed, straight_acceleration, turn_rate, turn_acceleration
        pairs = [value if isinstance(value, tuple) else (value, value) for value in values]
        current = super().settings(*(first for first, _ in pairs))
        usual = self._base.usual[1::2]
        stops = self._stops or usual
        if current is not None:
            both = zip(usual, stops, strict=True)
            straight, turn = (start if start == stop else (start, stop) for start, stop in both)
            return current[0], straight, current[2], turn
        self._stops = tuple(
            before if stop is None else self._check_setting(abs(whole(stop)), index)
            for index, before, (_, stop) in zip((1, 3), stops, pairs[1::2], strict=True)
        )
        if self._stops != usual:
            self.tell(Call.SET_SLOWING, *self._stops)
        return None

    def _check_setting(self, value: int, index: int) -> int:
        controls = self.distance_control, self.heading_control
        return controls[index // 2].check(value, index % 2)  # type: ignore[no-any-return]

    def brake(self) -> None:
        """Stop the drive base, and let its motors brake."""
        self._end(0)

    def hold(self) -> None:
        """Stop the drive base, and hold its wheels."""
        return self._move(0, 0, "hold()", wait=False)

    def done(self) -> bool:
        """Return whether no move of the drive base is under way."""
        now_us = self.brick.read("state", *self.port_names)
        return not self._base.active or self._base.done(now_us)

    def stalled(self) -> bool:
        """Return whether something has blocked the robot."""
        self.brick.read("state", *self.port_names)
        return self._base.stalled

    def reset(self, distance: float = 0, angle: float = 0) -> None:
        """Stop the drive base, and make it show a distance in mm and an angle in degrees, by default 0, from now on."""
        self.stop()
        base = self._base
        if base.uses_gyro:
            self.brick.tell(0, Call.SET_GYRO, whole(angle))
        super().reset()
        total, difference = self._zeros
        total -= base.distance.settings.counts(whole(distance))
        self._zeros = total, difference - base.heading.settings.counts(whole(angle))


class GyroDriveBase(DriveBase):
    """A drive base that takes its heading from the gyro; some beta versions of the library have this name."""

    def __init__(self, *given: Any, **named: Any) -> None:
        super().__init__(*given, **named)
        self.use_gyro(True)


class ColorSensor(ev3devices.ColorSensor):
    """The EV3 colour sensor under version 4 of Pybricks, which returns `Color.NONE` for no colour, not None."""

    def color(self, surface: bool = True) -> Any:
        """Return the colour that the sensor sees; `Color.NONE` if there is none."""
        color = super().color()
        return Color.NONE if color is None else Color[color.name]


class InfraredSensor(ev3devices.InfraredSensor):
    """The EV3 infrared sensor under version 4 of Pybricks, which returns pressed buttons as a set, not a list."""

    COLLECT = set


class GyroSensor(ev3devices.GyroSensor):
    """The EV3 gyro under version 4 of Pybricks, which programs can calibrate."""

    def calibrate(self) -> None:
        """Calibrate the gyro, which sets the angle to 0."""
        self.reset_angle(0)


class StopWatch(tools.StopWatch):
    """A stopwatch under version 4 of Pybricks, which also says whether it is running."""

    def running(self) -> bool:
        """Return whether the stopwatch is running."""
        return self._runs


def read_input_byte(last: bool = False, chr: bool = False) -> int | str | None:  # noqa: A002
    """Return None: no computer sends bytes to a simulated hub."""
    Connected.brick.command()
    return None


# Tasks


def _steps(task: Any) -> Waiting[Any]:
    """Return an iterator over the times, in microseconds, until which a task waits.

    Raises:
        TypeError: it is not a task.
    """
    return task.__await__() if hasattr(task, "__await__") else iter(task)  # type: ignore[no-any-return]


def run_task(task: Any = None) -> Any:
    """Run a task until it ends, and return None; without a task, return whether one is running.

    Raises:
        RuntimeError: a task is running already.
    """
    brick = Connected.brick
    if task is None:
        return brick.in_task
    if brick.in_task:
        raise RuntimeError("Run loop already active.")
    brick.in_task = True
    try:
        brick.block(_steps(task))
        return None
    finally:
        brick.in_task = False


class multitask:  # noqa: N801 - as the library names it
    """Several tasks that run at the same time when a task awaits this object."""

    def __init__(self, *tasks: Any, race: bool = False) -> None:
        self._tasks = [_steps(task) for task in tasks]
        self._race = race

    def __await__(self) -> Waiting[Any]:
        tasks = dict(enumerate(self._tasks))
        results = [None] * len(tasks)
        earlier_us: list[int] = []
        try:
            while tasks:
                until_us = []
                for number, task in [*tasks.items()]:
                    try:
                        until_us.append(task.send(None) or Connected.brick.command())
                    except StopIteration as end:
                        results[number] = end.value
                        del tasks[number]
                        if self._race:
                            return tuple(results)
                # A command of one task may end the wait of another, so time passes only when no wait has changed.
                if tasks and until_us == earlier_us:
                    yield min(until_us)
                earlier_us = until_us
            return tuple(results)
        finally:
            for task in self._tasks:
                task.close()
