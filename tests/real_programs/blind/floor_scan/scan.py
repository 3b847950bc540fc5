#!/usr/bin/env python3
"""Scans a rectangle of floor row by row and writes scan.csv beside this file."""
import csv
import json
import math
import os
import time

from ev3dev2.motor import MoveTank, SpeedPercent
from ev3dev2.sensor.lego import ColorSensor, GyroSensor

HERE = os.path.dirname(os.path.realpath(__file__))

with open(os.path.join(HERE, 'config.json')) as fp:
    CFG = json.load(fp)

MM_PER_DEG = math.pi * CFG['wheel_diameter_mm'] / 360.0

tank = MoveTank(CFG['motors']['left'], CFG['motors']['right'])
light = ColorSensor(CFG['sensors']['light'])
gyro = GyroSensor(CFG['sensors']['gyro'])


def distance():
    return (tank.left_motor.degrees + tank.right_motor.degrees) / 2 * MM_PER_DEG


def scan_row(row, writer):
    n = 0
    start = distance()
    speed = SpeedPercent(CFG['speed_percent'])
    tank.on_for_degrees(speed, speed, CFG['row_length_mm'] / MM_PER_DEG, block=False)
    tank.wait_until('running', timeout=200)
    while tank.is_running:
        writer.writerow([row, round(distance() - start, 1),
                         light.reflected_light_intensity, gyro.angle, round(time.time() - T0, 3)])
        n += 1
        time.sleep(0.02)
    return n


def u_turn(clockwise):
    # pivot around the inner wheel, twice 90 degrees with a short straight part between
    quarter = CFG['axle_track_mm'] * math.pi / 4 / MM_PER_DEG
    straight = max(0, CFG['row_spacing_mm']) / MM_PER_DEG
    sign = 1 if clockwise else -1
    tank.on_for_degrees(15 * sign, -15 * sign, quarter)
    tank.on_for_degrees(15, 15, straight)
    tank.on_for_degrees(15 * sign, -15 * sign, quarter)
    time.sleep(0.3)


T0 = time.time()

with open(os.path.join(HERE, 'scan.csv'), 'w', newline='') as out:
    w = csv.writer(out)
    w.writerow(['row', 'mm', 'reflected', 'gyro', 't'])
    for row in range(CFG['rows']):
        n = scan_row(row, w)
        print("row %d: %d samples" % (row, n))
        if row < CFG['rows'] - 1:
            u_turn(clockwise=(row % 2 == 0))

tank.off(brake=False)
