#!/usr/bin/env python3
"""Radar station on the desk: ultrasonic sensor on a turntable, picture on the LCD, data in radar.csv"""
import csv
import math
import os
import time
from collections import namedtuple

from ev3dev2.display import Display
from ev3dev2.motor import OUTPUT_A, MediumMotor, SpeedDPS
from ev3dev2.sensor import INPUT_1
from ev3dev2.sensor.lego import TouchSensor, UltrasonicSensor

GEAR = 3                    # 12 -> 36 teeth
SWEEPS = 4
FROM, TO, STEP = -90, 90, 5
RANGE_CM = 100.0

Echo = namedtuple('Echo', 'sweep angle cm')

table = MediumMotor(OUTPUT_A)
us = UltrasonicSensor()
end_stop = TouchSensor(INPUT_1)
lcd = Display()
outfile = os.path.join(os.path.dirname(os.path.abspath(__file__)), 'radar.csv')


def home():
    # turn left until the switch is pressed, that's -100 degrees
    if not end_stop.is_pressed:
        table.on(SpeedDPS(-150))
        end_stop.wait_for_pressed(timeout_ms=8000)
        table.off()
    time.sleep(0.2)
    table.position = -100 * GEAR


def to_xy(angle, cm):
    a = math.radians(angle)
    r = min(cm, RANGE_CM) / RANGE_CM * 85
    return int(89 + r * math.sin(a)), int(120 - r * math.cos(a))


def draw(echoes, angle):
    lcd.clear()
    for r in (28, 57, 85):
        lcd.draw.arc((89 - r, 120 - r, 89 + r, 120 + r), 180, 360, fill='black')
    lcd.draw.line((89, 120) + to_xy(angle, RANGE_CM), fill='black')
    for e in echoes:
        if e.cm < RANGE_CM:
            x, y = to_xy(e.angle, e.cm)
            lcd.draw.ellipse((x - 2, y - 2, x + 2, y + 2), fill='black')
    lcd.update()


def sweep(n):
    angles = list(range(FROM, TO + 1, STEP))
    if n % 2:
        angles.reverse()
    echoes = []
    for a in angles:
        table.on_to_position(SpeedDPS(300), a * GEAR)
        time.sleep(0.06)
        echoes.append(Echo(n, a, round(us.distance_centimeters, 1)))
        draw(echoes, a)
    nearest = min(echoes, key=lambda e: e.cm)
    print('sweep %d nearest %.1f cm at %d deg' % (n, nearest.cm, nearest.angle))
    return echoes


home()
with open(outfile, 'w') as f:
    w = csv.writer(f, delimiter=';')
    w.writerow(Echo._fields)
    for n in range(SWEEPS):
        w.writerows(sweep(n))
        f.flush()
table.on_to_position(SpeedDPS(300), 0, brake=False)
