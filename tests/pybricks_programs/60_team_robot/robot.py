#!/usr/bin/env pybricks-micropython
from pybricks.hubs import EV3Brick
from pybricks.ev3devices import (Motor, TouchSensor, ColorSensor,
                                 InfraredSensor, UltrasonicSensor, GyroSensor)
from pybricks.parameters import Port, Stop, Direction, Button, Color
from pybricks.tools import wait, StopWatch, DataLog
from pybricks.robotics import DriveBase
import config

ev3 = EV3Brick()
lm = Motor(Port.B, Direction.COUNTERCLOCKWISE, [12, 20])
rm = Motor(Port.C, Direction.COUNTERCLOCKWISE, [12, 20])
front = Motor(Port.A)
back = Motor(Port.D)
gyro = GyroSensor(Port.S1, direction=Direction.COUNTERCLOCKWISE)
base = DriveBase(lm, rm, config.WHEEL, config.TRACK)


def turn_to(heading, kp=2):
    error = heading - (-gyro.angle())
    n = 0
    while abs(error) > 1 and n < 500:
        rate = error * kp
        if abs(rate) < 15:
            rate = 15 if rate > 0 else -15
        base.drive(0, rate)
        error = heading + gyro.angle()
        n += 1
        wait(10)
    base.stop()


def straight(mm, speed=config.SPEED):
    base.stop()
    base.settings(speed, speed * 2, 90, 180)
    base.straight(mm)
