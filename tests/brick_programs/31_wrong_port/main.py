#!/usr/bin/env python3
import time
from ev3dev2.motor import LargeMotor, MediumMotor, MoveSteering, OUTPUT_A, OUTPUT_B, OUTPUT_C
from ev3dev2.sensor import INPUT_1, INPUT_2
from ev3dev2.sensor.lego import TouchSensor, ColorSensor

drive = MoveSteering(OUTPUT_B, OUTPUT_C)
col = ColorSensor(INPUT_2)


def grab():
    # the claw. Works at home on the other robot
    claw = MediumMotor(OUTPUT_A)
    claw.on_for_degrees(50, 90)


def wait_for_touch():
    ts = TouchSensor(INPUT_1)
    while not ts.is_pressed:
        time.sleep(0.01)


print('color:', col.color_name)
drive.on_for_rotations(steering=0, speed=30, rotations=1)
print('arrived')
try:
    grab()
except Exception as ex:
    print('no claw today:', ex)
wait_for_touch()
print('pressed')
drive.on_for_rotations(0, -30, 1)
