#!/usr/bin/env python3
"""All ports at the top, as our teacher wants it."""
from ev3dev2.motor import LargeMotor, MediumMotor, OUTPUT_A, OUTPUT_B, OUTPUT_D
from ev3dev2.sensor import INPUT_1, INPUT_4
from ev3dev2.sensor.lego import ColorSensor, TouchSensor

LEFT_MOTOR_PORT = OUTPUT_A
RIGHT_MOTOR_PORT = OUTPUT_D
ARM_PORT = OUTPUT_B
COLOR_PORT = INPUT_4
BUTTON_PORT = INPUT_1

m1 = LargeMotor(LEFT_MOTOR_PORT)
m2 = LargeMotor(RIGHT_MOTOR_PORT)
arm = MediumMotor(ARM_PORT)
color = ColorSensor(COLOR_PORT)
button = TouchSensor(BUTTON_PORT)

arm.on_for_degrees(25, 45)
print(color.reflected_light_intensity, button.is_pressed, arm.position)
