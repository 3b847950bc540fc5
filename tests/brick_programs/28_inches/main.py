#!/usr/bin/env python3
# american robot: everything in inches
from ev3dev2.motor import MoveTank, LargeMotor, OUTPUT_B, OUTPUT_C, SpeedRPM
from ev3dev2.sensor.lego import UltrasonicSensor
from ev3dev2.unit import DistanceInches, DistanceFeet, DistanceMillimeters
from time import sleep
import math

us = UltrasonicSensor()
tank = MoveTank(OUTPUT_B, OUTPUT_C)

wheel = DistanceMillimeters(56)
inches_per_turn = math.pi * wheel.mm / 25.4

def go(dist):
    turns = dist.mm / 25.4 / inches_per_turn
    tank.on_for_rotations(SpeedRPM(80), SpeedRPM(80), turns)

before = us.distance_inches
sleep(0.1)
print('wall at', 'infinity' if before > 100 else '%.1f"' % before)
go(DistanceFeet(1))
sleep(0.3)
after = us.distance_inches
print('closer by %.0f inches' % (before - after))
go(DistanceInches(-12))
sleep(0.3)
print('and back:', abs(us.distance_inches - before) < 1)

ping_in = us.distance_inches_ping
sleep(0.3)
ping_cm = us.distance_centimeters_ping
print('ping agrees:', abs(ping_in * 2.54 - ping_cm) < 1.5)
print('mode', us.mode)
print('continuous:', abs(us.distance_centimeters_continuous - ping_cm) < 1.5, us.mode)
print('other sensor:', us.other_sensor_present, us.mode)
print(DistanceInches(1) < DistanceFeet(1), 2 * DistanceInches(3))
