#!/usr/bin/env pybricks-micropython

from pybricks import ev3brick as brick
from pybricks.ev3devices import (Motor, TouchSensor, ColorSensor,
                                 InfraredSensor, UltrasonicSensor, GyroSensor)
from pybricks.parameters import (Port, Stop, Direction, Button, Color,
                                 SoundFile, ImageFile, Align)
from pybricks.tools import print, wait, StopWatch
from pybricks.robotics import DriveBase

# Write your program here
brick.sound.beep()
left = Motor(Port.B)
right = Motor(Port.C)
robot = DriveBase(left, right, 56, 114)

robot.drive_time(100, 0, 2000)
robot.stop(Stop.BRAKE)
wait(500)
weg = robot.distance()
robot.drive_time(0, 45, 2000)
robot.stop(Stop.BRAKE)
wait(500)
print("fertig")
print("weg", 185 <= weg <= 215)
print("winkel", 80 <= robot.angle() <= 100)
