#!/usr/bin/env pybricks-micropython
"""Follow the edge of a line with a drive base, round the lollipop (Pybricks)."""
# %sim_magic -b Lollipop

from pybricks.hubs import EV3Brick
from pybricks.ev3devices import Motor, TouchSensor, ColorSensor, InfraredSensor, UltrasonicSensor, GyroSensor
from pybricks.parameters import Port, Stop, Direction, Button, Color
from pybricks.tools import wait, StopWatch, DataLog
from pybricks.robotics import DriveBase
from pybricks.media.ev3dev import SoundFile, ImageFile

# Black reads 5 and white 85: halfway between, the sensor is over the edge of the line.
EDGE = 45
SPEED = 80
GAIN = 1.5

left_motor = Motor(Port.B)
right_motor = Motor(Port.C)
robot = DriveBase(left_motor, right_motor, wheel_diameter=56, axle_track=180)
eye = ColorSensor(Port.S2)

# The further the sensor is from the edge, the faster the robot turns back to it.
while robot.distance() < 1900:
    error = eye.reflection() - EDGE
    robot.drive(SPEED, GAIN * error)
    wait(10)
robot.stop()
print("Distance: " + str(robot.distance()))
