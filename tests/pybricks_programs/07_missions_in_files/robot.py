from pybricks.ev3devices import Motor
from pybricks.hubs import EV3Brick
from pybricks.parameters import Port
from pybricks.robotics import DriveBase

ev3 = EV3Brick()
arm = Motor(Port.D)
base = DriveBase(Motor(Port.B), Motor(Port.C), wheel_diameter=68.8, axle_track=150)


def fast():
    base.stop()
    base.settings(250, 500, 90, 300)


def slow():
    base.stop()
    base.settings(100, 200, 60, 200)
