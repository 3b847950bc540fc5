"""`DriveBase` of `pybricks.robotics`."""

from __future__ import annotations

from typing import Any, ClassVar

from tuisim.engine.core.commands.calls import Call
from tuisim.engine.core.servo.control import Controller
from tuisim.engine.core.servo.trajectory import MILLI
from tuisim.engine.shim.plugs import PART_OF_KIND
from tuisim.engine.shim.pybricks.brick import (
    Connected,
    Waiting,
    invalid_argument,
    not_permitted,
    whole,
)
from tuisim.engine.shim.pybricks.motor import Control, Motor, ending_of
from tuisim.engine.shim.pybricks.parameters import Stop
from tuisim.engine.shim.pybricks.unsimulated import LOGGER
from tuisim.engine.shim.unsupported.modules import refused_part


class DriveBase(Connected):
    """A robot with two driven wheels, which drives straight and turns."""

    CONTROL: ClassVar[type[Control]] = Control
    MIN_SIZE_MM: ClassVar[float] = 1 / 65536
    """Smallest diameter of the wheels, and smallest axle track, in mm: the firmware computes in steps of 1/65536."""
    current: ClassVar[DriveBase | None] = None
    """The newest drive base of the program; None before the first. A further one takes its place."""
    log = refused_part("DriveBase", "log", LOGGER)

    def __init__(
        self, left_motor: Motor, right_motor: Motor, wheel_diameter: float, axle_track: float
    ) -> None:
        for motor in (left_motor, right_motor):
            if not isinstance(motor, Motor):
                raise TypeError(f"a Motor is needed, not {type(motor).__name__}")
        kind = PART_OF_KIND[left_motor.simulated.kind]
        self.brick.plugs.make_wheels(*left_motor.port_names, *right_motor.port_names, kind)
        left, right = left_motor.simulated, right_motor.simulated
        are_alike = left.control.settings == right.control.settings
        is_tiny = min(wheel_diameter, axle_track) < self.MIN_SIZE_MM
        if left is right or not are_alike or is_tiny:
            raise invalid_argument()
        self.left, self.right = left_motor, right_motor
        if DriveBase.current is not None:
            self._take_place(DriveBase.current)
        DriveBase.current = self
        self.port_names = (*left_motor.port_names, *right_motor.port_names)
        sim = self.brick.session.sim
        numbers = sim.find_number(left), sim.find_number(right)
        self.brick.tell(0, Call.BUILD_BASE, *numbers, float(wheel_diameter), float(axle_track))
        self._number = next(reversed(sim.bases))
        self._base = base = sim.bases[self._number]
        self.distance_control = self.CONTROL(self, base.distance)
        self.heading_control = self.CONTROL(self, base.heading)
        self._zeros = 0, 0
        self.reset()

    def _take_place(self, earlier: DriveBase) -> None:
        """Stop the program's earlier drive base before this one is created, because both may use the same motors."""
        earlier.stop()

    def tell(self, call: Call, *values: float | None) -> None:
        """Give a command with its values to the simulated drive base; None stands for a value that is not given."""
        self.brick.tell(self._number, call, *values)

    def has_motor(self, motor: Any) -> bool:
        """Return whether a motor is one of the two motors of this drive base."""
        return any(ours.simulated is motor.simulated for ours in (self.left, self.right))

    @property
    def holds_by_gyro(self) -> bool:
        """Whether the drive base drives or holds, and takes its heading from the gyro."""
        return self._base.uses_gyro and self._base.active

    # Motions

    def straight(self, distance: float) -> None:
        """Drive a distance in mm, and hold the wheels."""
        return self._move(whole(distance), 0, "straight()")

    def turn(self, angle: float) -> None:
        """Turn by an angle in degrees, clockwise, and hold the wheels."""
        return self._move(0, whole(angle), "turn()")

    def _move(
        self,
        distance_mm: float,
        angle_deg: float,
        call: str,
        then: Any = Stop.HOLD,
        *,
        wait: bool = True,
    ) -> None:
        ending = ending_of(self.left.STOPS, then)
        self.brick.command()
        try:
            self.tell(Call.MOVE_BASE, distance_mm, angle_deg, ending)
        except ValueError:
            raise invalid_argument() from None
        return self.brick.finish(self._wait_for_end(call), self.stop) if wait else None

    def _wait_for_end(self, call: str) -> Waiting[None]:
        """Wait until a move is over: yield the times in microseconds at which to check again.

        If something blocks the wheels, print a message once; `call` is the call that waits, for this message.
        """
        base = self._base

        def done(now_us: int) -> bool:
            if base.stalled:
                self.brick.say_stalled("the wheels are", call)
            return not base.active or base.done(now_us)

        return self.brick.until_done(done, base)

    def drive(
        self,
        speed: float | None = None,
        turn_rate: float | None = None,
        *,
        drive_speed: float | None = None,
    ) -> None:
        """Drive at a speed in mm/s and a clockwise rate of turn in degrees per second, until the next command.

        Args:
            speed, turn_rate: Both are needed.
            drive_speed: The speed, under the name that the handbook gives it.
        """
        speed = drive_speed if speed is None else speed
        if speed is None or turn_rate is None:
            raise TypeError("drive() needs a speed and a turn_rate")
        self.brick.command()
        self.tell(Call.DRIVE_BASE, whole(speed), whole(turn_rate))

    def stop(self) -> None:
        """Stop the drive base, and let its motors coast."""
        self._end(None)

    def _end(self, actuation: int | None) -> None:
        """End a motion: run the motors with a power in hundredths of a percent; None lets them coast, 0 brakes them."""
        self.brick.command()
        self.tell(Call.STOP_BASE, actuation)

    # Readings

    def _read(self) -> int:
        """Advance the simulation by the time that reading both motors takes; return the time in microseconds."""
        return self.brick.read("position", *self.port_names)

    def distance(self) -> int:
        """Return the distance in mm that the robot has driven; `reset` sets it."""
        return self._position(self._read())[0]

    def angle(self) -> int:
        """Return the angle in degrees by which the robot has turned clockwise; `reset` sets it."""
        return self._position(self._read())[1]

    def _position(self, now_us: int) -> tuple[int, int]:
        total, difference = self._base.find_millis(now_us)
        return (
            self._base.distance.settings.units(round(total / MILLI) - self._zeros[0]),
            self._base.heading.settings.units(round(difference / MILLI) - self._zeros[1]),
        )

    def state(self) -> tuple[int, int, int, int]:
        """Return distance in mm, speed in mm/s, angle in degrees and rate of turn in degrees per second."""
        now_us = self._read()
        base = self._base
        (distance, angle), (speed, turn_rate) = self._position(now_us), base.find_rates(now_us)
        return (
            distance,
            base.distance.settings.tell(speed),
            angle,
            base.heading.settings.tell(turn_rate),
        )

    def reset(self) -> None:
        """Set the distance and the angle that the drive base measures to 0."""
        total, difference = self._base.find_millis(self.brick.command())
        self._zeros = round(total / MILLI), round(difference / MILLI)

    def change_setting(self, control: Controller, setting: int, value: int) -> None:
        """Change a setting of one of the drive base's two controllers.

        Args:
            control: The controller.
            setting: The number of the setting.
            value: Its new value, in the units of the controller, which are called counts.
        """
        self.tell(Call.SET_BASE_CONTROL, control is self._base.heading, setting, value)

    def has_let_go(self) -> bool:
        """Return False: after every move of a drive base, its motors are held."""
        return False

    def move_done(self, now_us: int, control: Controller) -> bool:
        """Return whether no move of a controller of the drive base is under way."""
        at = 0 if control is self._base.distance else 1
        return control.done(
            now_us, self._base.find_millis(now_us)[at], self._base.find_rates(now_us)[at]
        )

    # Settings

    def settings(
        self,
        straight_speed: float | None = None,
        straight_acceleration: float | None = None,
        turn_rate: float | None = None,
        turn_acceleration: float | None = None,
    ) -> tuple[int, ...] | None:
        """Set speed and acceleration of `straight` and of `turn`; without arguments, return these four.

        They are in mm/s, mm/s², °/s and °/s².
        """
        base = self._base
        given: tuple[Any, ...] = (
            straight_speed,
            straight_acceleration,
            turn_rate,
            turn_acceleration,
        )
        if all(one is None for one in given):
            return base.usual
        if base.active and not self.CONTROL.SETTINGS_WHILE_ACTIVE:
            raise not_permitted()
        chosen = [
            usual if value is None else self._check_setting(abs(whole(value)), at)
            for at, (value, usual) in enumerate(zip(given, base.usual, strict=True))
        ]
        self.tell(Call.SET_BASE, *chosen)
        return None

    def _check_setting(self, value: int, at: int) -> int:
        """Return a speed or an acceleration, reduced to the highest that the motors allow.

        Args:
            value: In mm/s, mm/s², °/s or °/s².
            at: 0 for the speed and 1 for the acceleration of straight moves, 2 and 3 for those of turns.
        """
        settings = (self._base.distance if at < 2 else self._base.heading).settings
        return min(value, settings.units(settings.acceleration if at % 2 else settings.speed))
