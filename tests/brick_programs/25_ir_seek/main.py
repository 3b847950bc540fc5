#!/usr/bin/env python3
from ev3dev2.motor import *
from ev3dev2.sensor.lego import InfraredSensor
import time

ir = InfraredSensor()
tank = MoveTank(OUTPUT_B, OUTPUT_C)

print("prox", 0 <= ir.proximity <= 100)
print("buttons", ir.buttons_pressed(1))
print("beacon on channel 4?", ir.beacon(channel=4))

start = time.time()
seen = 0
rounds = 0
while time.time() - start < 10:
    rounds = rounds + 1
    d = ir.distance(1)
    if d == None or d <= -1:
        # turn on the spot and look for it
        tank.on(10, -10)
    elif d < 10:
        print("got it!")
        break
    else:
        seen = seen + 1
        h = ir.heading(1)
        tank.on(max(min(20 + h, 50), -50), max(min(20 - h, 50), -50))
    time.sleep(0.05)
tank.off()
print("seen:", seen)
print("heading and distance:", ir.heading_and_distance(1))

# now just with proximity
tank.on(25, 25)
t = time.time()
while ir.proximity > 40 and time.time() - t < 3:
    time.sleep(0.05)
tank.off()
print("obstacle" if ir.proximity <= 40 else "no obstacle")

try:
    ir.distance(5)
except AssertionError:
    print("only channels 1 to 4")
