#!/usr/bin/env python3
from ev3dev2.motor import LargeMotor, OUTPUT_A, OUTPUT_D
from ev3dev2.sensor.lego import TouchSensor, ColorSensor, UltrasonicSensor
ts = TouchSensor()
cl = ColorSensor()
us = UltrasonicSensor()
l = LargeMotor(OUTPUT_A)
r = LargeMotor(OUTPUT_D)
print(ts.is_pressed, cl.color, us.distance_inches > 10)
