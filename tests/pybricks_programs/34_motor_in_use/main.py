#!/usr/bin/env pybricks-micropython
from pybricks.ev3devices import Motor, TouchSensor
from pybricks.parameters import Port
from pybricks.robotics import DriveBase

left, right = Motor(Port.B), Motor(Port.C)
base = DriveBase(left, right, 56, 114)
base.straight(100)
try:
    left.run_angle(200, 90)
except OSError as e:
    print("motor", e.args[0])
try:
    base.settings(200, 300)
except OSError as e:
    print("settings", e.args[0])
base.stop()
base.settings(200, 300)
print("after stop", base.settings()[:2] == (200, 300), base.settings())
left.run_angle(200, 90)
print(left.angle() - right.angle())
try:
    Motor(Port.S1)
except ValueError:
    print("bad port")
