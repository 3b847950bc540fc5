#!/usr/bin/env pybricks-micropython
from pybricks.ev3devices import Motor, UltrasonicSensor
from pybricks.parameters import Port, Stop
from pybricks.tools import wait, StopWatch
from pybricks.robotics import DriveBase

FAR = 250
left = Motor(Port.B)
right = Motor(Port.C)
robot = DriveBase(left, right, 56, 120)
eyes = UltrasonicSensor(Port.S1)
clock = StopWatch()
turns = 0
nearest = 9999
while clock.time() < 20000:
    d = eyes.distance()
    nearest = min(nearest, d)
    if d < FAR:
        robot.stop(Stop.BRAKE)
        robot.turn(-90)
        turns += 1
    else:
        robot.drive(180, 0)
    wait(10)
robot.stop()
print("turns", turns == 3)
print("never touched", nearest > 100)
