from robot import base, front, back, gyro, turn_to, straight
from pybricks.parameters import Stop
from pybricks.tools import wait


def run01():
    gyro.reset_angle(0)
    straight(300)
    front.run_time(300, 700, Stop.HOLD, False)
    turn_to(45)
    straight(-100, speed=100)
    front.run_target(500, 0)


def run02():
    gyro.reset_angle(0)
    base.reset()
    turn_to(-45)
    back.run_angle(600, -270, wait=False)
    straight(150)
    while not back.control.done():
        wait(10)
    base.stop()
