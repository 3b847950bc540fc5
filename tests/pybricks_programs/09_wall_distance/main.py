#!/usr/bin/env pybricks-micropython
from pybricks.hubs import EV3Brick
from pybricks.ev3devices import Motor, UltrasonicSensor
from pybricks.parameters import Port
from pybricks.tools import wait, StopWatch
from pybricks.robotics import DriveBase

ev3 = EV3Brick()
us = UltrasonicSensor(Port.S4)
robot = DriveBase(Motor(Port.B), Motor(Port.C), 56, 118)
TARGET = 300
KP = 0.8
watch = StopWatch()
while watch.time() < 10000:
    error = us.distance() - TARGET
    speed = max(-200, min(200, KP * error))
    robot.drive(speed, 0)
    wait(20)
robot.stop()
print("at the wall", abs(us.distance() - TARGET) < 10)
print("moved", 840 < robot.distance() < 880)
