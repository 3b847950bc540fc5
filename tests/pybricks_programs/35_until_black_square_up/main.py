#!/usr/bin/env pybricks-micropython
# %sim_magic -b Grey_bands
from pybricks.ev3devices import Motor, ColorSensor
from pybricks.parameters import Port, Stop, Color
from pybricks.robotics import DriveBase
from pybricks.tools import wait

lm, rm = Motor(Port.B), Motor(Port.C)
ls, rs = ColorSensor(Port.S2), ColorSensor(Port.S3)
robot = DriveBase(lm, rm, 56, 180)

robot.drive(60, 0)
while ls.color() != Color.BLACK:
    wait(5)
robot.stop(Stop.BRAKE)
print("black at", robot.distance() // 10 * 10, ls.color())
lm.run(-50)
rm.run(-50)
left_ok = right_ok = False
while not (left_ok and right_ok):
    if ls.reflection() > 20:
        lm.hold()
        left_ok = True
    if rs.reflection() > 20:
        rm.hold()
        right_ok = True
print("squared", abs(lm.angle() - rm.angle()) < 10)
