#!/usr/bin/env python3
from ev3dev2.motor import *
from ev3dev2.sound import *
from ev3dev2.sensor import *
from ev3dev2.sensor.lego import *
from time import sleep
import math
import random

# Lesson 3: make a square!
# by Maya and Oliver, class 7b

tank_drive = MoveTank(OUTPUT_B, OUTPUT_C)
sound = Sound()

SIDE = 1.5     # rotations
TURN = 0.8     # we tried 0.75 first, it was too small

print("Starting the square")
for i in range(4):
    print("side", i + 1)
    tank_drive.on_for_rotations(SpeedPercent(40), SpeedPercent(40), SIDE)
    sleep(0.2)
    # turn to the right
    tank_drive.on_for_rotations(SpeedPercent(20), SpeedPercent(-20), TURN)
    sleep(0.2)

sound.beep()
print("Done!")
