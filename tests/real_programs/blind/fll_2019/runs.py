# one function per run, the docstring is the name in the menu
from ev3dev2.motor import SpeedPercent


def run_crane(r):
    """Crane"""
    r.reset()
    r.gyro_straight(68)
    r.until_line()
    r.gyro_straight(9, speed=15)
    r.arm.on_for_degrees(SpeedPercent(30), 140)
    r.gyro_straight(-82, speed=70)


def run_swing(r):
    """Swing+Lift"""
    r.reset()
    r.gyro_straight(52)
    r.gyro_turn(45)
    r.gyro_straight(38, heading=45)
    r.lift.on_for_rotations(SpeedPercent(80), 4)
    r.gyro_straight(-20, heading=45)
    r.lift.on_for_rotations(SpeedPercent(-80), 4)
    r.gyro_turn(0)
    r.gyro_straight(-60, speed=70)


def run_bridge(r):
    """Bridge"""
    r.reset()
    r.gyro_straight(120, speed=55)
    r.gyro_turn(-90)
    r.gyro_straight(50, speed=75, heading=-90, kp=2)
    # stay on the bridge!


RUNS = [run_crane, run_swing, run_bridge]
