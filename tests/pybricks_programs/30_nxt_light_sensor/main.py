#!/usr/bin/env pybricks-micropython
from pybricks.ev3devices import Motor
from pybricks.nxtdevices import LightSensor
from pybricks.parameters import Port
from pybricks.robotics import DriveBase
from pybricks.tools import wait

robot = DriveBase(Motor(Port.B), Motor(Port.C), 56, 114)
print("begin")
light = LightSensor(Port.S1)
robot.drive(80, 0)
while light.reflection() > 30:
    wait(10)
robot.stop()
