#!/usr/bin/env micropython
# simplest line follower, one sensor, right edge
# (micropython starts MUCH faster than python3)

from time import sleep
from ev3dev2.motor import MoveSteering, OUTPUT_A, OUTPUT_B
from ev3dev2.sensor.lego import ColorSensor
from ev3dev2.button import Button

steer = MoveSteering(OUTPUT_A, OUTPUT_B)
cl = ColorSensor()
btn = Button()

# press any button to start, any button to stop
print("Press a button")
while not btn.any():
    sleep(0.01)
while btn.any():
    sleep(0.01)

while not btn.any():
    if cl.reflected_light_intensity < 30:
        # black -> right
        steer.on(30, 25)
    else:
        # white -> left
        steer.on(-30, 25)
    sleep(0.02)

steer.off()
