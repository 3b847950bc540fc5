#!/usr/bin/env pybricks-micropython
import time
from pybricks.hubs import EV3Brick
from pybricks.ev3devices import Motor
from pybricks.parameters import Port
from pybricks.robotics import DriveBase

ev3 = EV3Brick()
robot = DriveBase(Motor(Port.B), Motor(Port.C), 55.5, 104)
LIMIT = 15
t0 = time.time()


def there_and_back():
    robot.straight(400)
    robot.straight(-400)


for n, mission in enumerate([there_and_back] * 3, 1):
    if LIMIT - (time.time() - t0) < 5:
        print("no time for", n)
        break
    print("mission", n)
    mission()
ev3.speaker.beep()
