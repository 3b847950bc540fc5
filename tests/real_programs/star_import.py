#!/usr/bin/env python3
from ev3dev2.motor import *
from ev3dev2.sensor import *
from ev3dev2.sensor.lego import *
from ev3dev2.led import Leds

robot = MoveTank(OUTPUT_A, OUTPUT_B)
kick = MediumMotor(OUTPUT_C)
touch = TouchSensor(INPUT_2)
robot.on_for_degrees(SpeedPercent(20), SpeedPercent(20), 180)
kick.on_for_rotations(SpeedPercent(50), 1)
print(kick.position, touch.value())
