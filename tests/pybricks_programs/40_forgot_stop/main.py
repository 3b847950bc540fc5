#!/usr/bin/env pybricks-micropython
from pybricks.ev3devices import Motor
from pybricks.parameters import Port
from pybricks.robotics import DriveBase

robot = DriveBase(Motor(Port.B), Motor(Port.C), wheel_diameter=56, axle_track=114)
robot.straight(100)
print("first")
robot.settings(straight_speed=300)
robot.straight(100)
print("second")
