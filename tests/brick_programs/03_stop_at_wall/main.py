#!/usr/bin/env python3
from ev3dev2.motor import OUTPUT_A, OUTPUT_B, OUTPUT_C, OUTPUT_D, MoveTank, MoveSteering, LargeMotor, SpeedPercent
from ev3dev2.sensor import INPUT_1, INPUT_2, INPUT_3, INPUT_4
from ev3dev2.sensor.lego import UltrasonicSensor, TouchSensor, ColorSensor, GyroSensor
from ev3dev2.led import Leds
from ev3dev2.sound import Sound
import time

robot = MoveSteering(OUTPUT_B, OUTPUT_C)
us = UltrasonicSensor()          # first one it finds
leds = Leds()
sound = Sound()

leds.set_color("LEFT", "GREEN")
leds.set_color("RIGHT", "GREEN")

start = time.time()
robot.on(0, 40)
# drive until something is closer than 30 cm
while us.distance_centimeters > 30:
    if us.distance_centimeters < 60:
        leds.set_color("LEFT", "AMBER")
        leds.set_color("RIGHT", "AMBER")
        robot.on(0, 15)
    time.sleep(0.01)
robot.off()
leds.set_color("LEFT", "RED")
leds.set_color("RIGHT", "RED")

distance = us.distance_centimeters
print("I stopped at " + str(distance) + " cm")
print("It took me " + str(round(time.time() - start, 1)) + " seconds")
sound.speak("wall ahead")
robot.on_for_rotations(0, -30, 1)
if us.distance_centimeters > distance:
    print("backed off OK")
else:
    print("hmm did not move?")
