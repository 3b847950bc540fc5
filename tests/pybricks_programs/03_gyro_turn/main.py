#!/usr/bin/env pybricks-micropython
from pybricks.hubs import EV3Brick
from pybricks.ev3devices import (Motor, TouchSensor, ColorSensor,
                                 InfraredSensor, UltrasonicSensor, GyroSensor)
from pybricks.parameters import Port, Stop, Direction, Button, Color
from pybricks.tools import wait, StopWatch, DataLog
from pybricks.robotics import DriveBase
from pybricks.media.ev3dev import SoundFile, ImageFile

ev3 = EV3Brick()
leftMotor = Motor(Port.B)
rightMotor = Motor(Port.C)
gyro = GyroSensor(Port.S2)
robot = DriveBase(leftMotor, rightMotor, wheel_diameter=56, axle_track=114)

def turnRight(degrees):
    gyro.reset_angle(0)
    while gyro.angle() < degrees:
        robot.drive(0, 60)
    robot.stop()
    leftMotor.brake()
    rightMotor.brake()
    wait(200)
    print("turned", degrees <= gyro.angle() <= degrees + 5)

for n in range(4):
    robot.straight(200)
    robot.stop()
    turnRight(90)
