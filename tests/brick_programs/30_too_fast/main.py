#!/usr/bin/env python3
# race car!!! by Leo
from ev3dev2.motor import MoveTank, OUTPUT_B, OUTPUT_C
from ev3dev2.led import Leds
from ev3dev2.sound import Sound
from time import sleep

car = MoveTank(OUTPUT_B, OUTPUT_C)
leds = Leds()
sound = Sound()

print("3")
sleep(0.5)
print("2")
sleep(0.5)
print("1")
sleep(0.5)
print("GO!")
sound.tone(1000, 300)

speed = 25
while True:
    print("speed", speed)
    leds.set_color("LEFT", "RED")
    car.on_for_seconds(speed, speed, 0.3)
    speed = speed * 2

print("finished")
