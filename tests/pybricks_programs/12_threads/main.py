#!/usr/bin/env pybricks-micropython
from pybricks.hubs import EV3Brick
from pybricks.ev3devices import Motor
from pybricks.parameters import Port, Stop, Direction, Button, Color
from pybricks.tools import wait, StopWatch
from pybricks.robotics import DriveBase
from threading import Thread

ev3 = EV3Brick()
arm = Motor(Port.A, Direction.COUNTERCLOCKWISE)
robot = DriveBase(Motor(Port.B), Motor(Port.C), wheel_diameter=56, axle_track=114)
finished = False

def arm_task():
    global finished
    for n in range(2):
        arm.run_target(300, 180)
        print("arm up", arm.angle())
        wait(1000)
        arm.run_target(300, 0)
        print("arm down", arm.angle())
        wait(1000)
    finished = True

t = Thread(target=arm_task)
t.start()
robot.straight(200)
print("straight 1")
robot.straight(200)
print("straight 2")
while not finished:
    wait(10)
print("arm stands at", arm.angle())
