#!/usr/bin/env pybricks-micropython
from pybricks.hubs import EV3Brick
from pybricks.ev3devices import Motor, TouchSensor
from pybricks.parameters import Port
from pybricks.robotics import DriveBase
from pybricks.tools import wait
from pybricks.media.ev3dev import SoundFile

ev3 = EV3Brick()
bumper = TouchSensor(Port.S1)
robot = DriveBase(Motor(Port.B), Motor(Port.C), 56, 118)
print("pressed", bumper.pressed())
robot.drive(200, 0)
while not bumper.pressed():
    wait(10)
robot.stop()
print("wall after", 1080 <= robot.distance() <= 1180)
ev3.speaker.play_file(SoundFile.OUCH)
robot.straight(-200)
robot.turn(180)
print("free", not bumper.pressed())
