#!/usr/bin/env pybricks-micropython
import random
from urandom import randint
from pybricks.ev3devices import Motor
from pybricks.parameters import Port
from pybricks.robotics import DriveBase

robot = DriveBase(Motor(Port.B), Motor(Port.C), 56, 152)
random.seed(4)
ways, angles = 0, 0
for i in range(10):
    if random.choice(["go", "turn"]) == "go":
        d = random.randint(50, 150)
        robot.straight(d)
        ways += d
    else:
        a = randint(-90, 90)
        robot.turn(a)
        angles += a
print(abs(ways - robot.distance()) <= 2)
print(abs(angles - robot.angle()) <= 3)
