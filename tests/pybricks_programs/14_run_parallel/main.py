#!/usr/bin/env pybricks-micropython
from pybricks.ev3devices import Motor
from pybricks.experimental import run_parallel
from pybricks.parameters import Port
from pybricks.robotics import DriveBase
from pybricks.tools import StopWatch, wait

a = Motor(Port.A)
d = Motor(Port.D)
robot = DriveBase(Motor(Port.B), Motor(Port.C), 56, 114)


def drive():
    robot.straight(200)


def armA():
    a.run_angle(200, 90)


def armD():
    wait(300)
    d.run_angle(200, -90)


watch = StopWatch()
run_parallel(drive, armA, armD)
print("all done after 2 s", 1750 <= watch.time() <= 1850)
print(a.angle(), d.angle(), robot.distance())
