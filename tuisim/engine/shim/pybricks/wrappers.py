"""Classes of version 2.0 that are Python files on the brick: they add what version 1.0 had to those in C."""

from __future__ import annotations

from tuisim.engine.core.servo.control import Ending
from tuisim.engine.shim.pybricks import motor, robotics
from tuisim.engine.shim.pybricks.parameters import Stop
from tuisim.engine.shim.pybricks.tools import wait


class Motor(motor.Motor):
    """The motor of version 2.0 of Pybricks, which keeps the methods of version 1.0."""

    def stop(self, stop_type: Stop = Stop.COAST) -> None:
        """Stop the motor: it coasts, brakes or holds."""
        if not isinstance(stop_type, Stop):
            raise ValueError("Invalid Argument")
        self._rest(Ending(stop_type.value))

    def stalled(self) -> bool:
        """Return whether something blocks the motor."""
        return self.control.stalled()

    def set_run_settings(self, max_speed: float, acceleration: float) -> None:
        """Set the highest speed of the motor's moves in °/s, and their acceleration in °/s²."""
        self.control.limits(max_speed, acceleration)

    def set_dc_settings(self, duty_limit: float, duty_offset: float) -> None:
        """Set the highest power, and the feed-forward power that the controller adds to its output, in percent."""
        self.control.limits(actuation=duty_limit)
        self.control.pid(feed_forward=duty_offset)

    def set_pid_settings(
        self,
        kp: float,
        ki: float,
        kd: float,
        tight_loop_limit: float,
        angle_tolerance: float,
        speed_tolerance: float,
        stall_speed: float,
        stall_time: float,
    ) -> None:
        """Set the gains of the motor's controller, and when a move is done and when the motor is stalled.

        Args:
            kp, ki, kd: The gains.
            tight_loop_limit: Has no effect.
            angle_tolerance, speed_tolerance: A move is done when the motor is as near as this to its target angle, in
                degrees, and to its target speed, in degrees per second.
            stall_speed, stall_time: A motor is stalled when it has been slower than this speed, in degrees per second,
                for this time, in ms.
        """
        self.control.pid(kp, ki, kd)
        self.control.target_tolerances(speed_tolerance, angle_tolerance)
        self.control.stall_tolerances(stall_speed, stall_time)


class DriveBase(robotics.DriveBase):
    """The drive base of version 2.0 of Pybricks, which keeps the methods of version 1.0."""

    def drive_time(self, speed: float, steering: float, time: float) -> None:
        """Drive for some time, then let the motors coast.

        Args:
            speed: In mm/s.
            steering: The rate of turn in degrees per second.
            time: The time in milliseconds.
        """
        self.drive(speed, steering)
        wait(time)
        self.stop()

    def stop(self, stop_type: Stop = Stop.COAST) -> None:
        """Stop the drive base: its motors coast, brake or hold."""
        match stop_type:
            case Stop.COAST:
                super().stop()
            case Stop.BRAKE:
                self._end(0)
            case Stop.HOLD:
                self.straight(0)
            case _:
                raise ValueError("Invalid Argument")
