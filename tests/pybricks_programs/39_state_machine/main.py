#!/usr/bin/env pybricks-micropython
from pybricks.hubs import EV3Brick
from pybricks.ev3devices import Motor
from pybricks.parameters import Port, Color, Stop
from pybricks.robotics import DriveBase
from pybricks.tools import wait, StopWatch

SEARCH, DRIVE, BACK, DONE = range(4)
NAMES = ("SEARCH", "DRIVE", "BACK", "DONE")
LIGHT = {SEARCH: Color.ORANGE, DRIVE: Color.GREEN, BACK: Color.YELLOW, DONE: Color.RED}
ev3 = EV3Brick()
robot = DriveBase(Motor(Port.B), Motor(Port.C), 56, 114)
timer = StopWatch()


def search():
    robot.drive(0, 30)
    if timer.time() >= 1500:
        robot.stop(Stop.BRAKE)
        robot.reset()
        return DRIVE
    return SEARCH


def drive():
    robot.drive(150, 0)
    return BACK if timer.time() >= 2000 else DRIVE


def back():
    robot.straight(-robot.distance())
    print("way back", abs(robot.distance()) < 30)
    robot.stop()
    return DONE


state = None
new = SEARCH
while new != DONE:
    if new != state:
        state = new
        print(NAMES[state])
        ev3.light.on(LIGHT[state])
        timer.reset()
    new = {SEARCH: search, DRIVE: drive, BACK: back}[state]()
    wait(10)
print(NAMES[new])
