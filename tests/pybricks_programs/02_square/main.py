#!/usr/bin/env pybricks-micropython
from pybricks.hubs import EV3Brick
from pybricks.ev3devices import (Motor, TouchSensor, ColorSensor,
                                 InfraredSensor, UltrasonicSensor, GyroSensor)
from pybricks.parameters import Port, Stop, Direction, Button, Color
from pybricks.tools import wait, StopWatch, DataLog
from pybricks.robotics import DriveBase
from pybricks.media.ev3dev import SoundFile, ImageFile


# This program requires LEGO EV3 MicroPython v2.0 or higher.
# Click "Open user guide" on the EV3 extension tab for more information.


# Create your objects here.
ev3 = EV3Brick()
motor_links = Motor(Port.B)
motor_rechts = Motor(Port.C)
robot = DriveBase(motor_links, motor_rechts, wheel_diameter=55.5, axle_track=104)

# Write your program here.
ev3.speaker.beep()
for i in range(4):
    print("Runde", i + 1)
    robot.straight(300)
    robot.turn(90)
print(robot.distance(), "mm", robot.angle(), "Grad")
ev3.speaker.beep()
