#!/usr/bin/env pybricks-micropython
"""Log the grey bands: print the light, and write it into a file (Pybricks)."""
# %sim_magic -b Grey_bands

from pybricks.hubs import EV3Brick
from pybricks.ev3devices import Motor, TouchSensor, ColorSensor, InfraredSensor, UltrasonicSensor, GyroSensor
from pybricks.parameters import Port, Stop, Direction, Button, Color
from pybricks.tools import wait, StopWatch, DataLog
from pybricks.robotics import DriveBase
from pybricks.media.ev3dev import SoundFile, ImageFile

left_motor = Motor(Port.B)
right_motor = Motor(Port.C)
robot = DriveBase(left_motor, right_motor, wheel_diameter=56, axle_track=180)
eye = ColorSensor(Port.S2)

watch = StopWatch()
data = DataLog("time_ms", "light", "way_mm", name="greys", timestamp=False)

# What is printed as NAME: NUMBER and what is written into the file are samples: the chart draws them.
robot.drive(150, 0)
light = eye.reflection()
while light > 5:
    data.log(watch.time(), light, robot.distance())
    print("Colour: " + str(light))
    wait(50)
    light = eye.reflection()
robot.stop()
print("Colour: " + str(eye.reflection()))
