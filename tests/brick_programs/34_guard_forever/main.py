#!/usr/bin/env python3
"""Obstacle avoider. Runs till Ctrl-C / SIGTERM (systemd starts and stops it)."""
import atexit
import random
import signal
import sys
from time import sleep

from ev3dev2.motor import MoveSteering, OUTPUT_B, OUTPUT_C
from ev3dev2.sensor.lego import UltrasonicSensor
from ev3dev2.led import Leds

steer = MoveSteering(OUTPUT_B, OUTPUT_C)
us = UltrasonicSensor()
leds = Leds()
turns = 0


@atexit.register
def shutdown():
    steer.off(brake=False)
    leds.all_off()
    print('shut down after %d turns' % turns)


def on_signal(signum, frame):
    print('signal', signum)
    sys.exit(0)


signal.signal(signal.SIGTERM, on_signal)
signal.signal(signal.SIGINT, on_signal)

print('guarding')
while True:
    d = us.distance_centimeters
    if d < 35:
        turns += 1
        leds.set_color('LEFT', 'RED')
        steer.off()
        steer.on_for_rotations(0, -30, 0.5)
        steer.on_for_rotations(random.choice((-100, 100)), 30, random.uniform(0.5, 1.2))
        leds.set_color('LEFT', 'GREEN')
    else:
        steer.on(0, 50 if d > 80 else 25)
    sleep(0.02)
