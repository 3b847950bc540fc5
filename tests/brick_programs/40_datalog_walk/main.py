#!/usr/bin/env micropython
# DataLog like the one of pybricks, since we came from there
from ev3dev2.motor import LargeMotor, OUTPUT_B, OUTPUT_C, MoveTank
from ev3dev2.sensor.lego import GyroSensor, UltrasonicSensor
from ev3dev2.stopwatch import StopWatch
from ev3dev2.sound import Sound
from ev3dev2.button import Button
import os
import random
import time


class DataLog:
    """log = DataLog('time', 'angle', name='log')"""

    def __init__(self, *headers, name='log', extension='csv', append=False):
        here = os.path.dirname(os.path.abspath(__file__))
        self.path = os.path.join(here, name + '.' + extension)
        self.file = open(self.path, 'a' if append else 'w')
        if headers:
            self.log(*headers)

    def log(self, *values):
        self.file.write(', '.join(str(v) for v in values) + '\n')
        self.file.flush()

    def __str__(self):
        with open(self.path) as f:
            return f.read()

    def close(self):
        self.file.close()


watch = StopWatch('walk')
gyro = GyroSensor()
us = UltrasonicSensor()
tank = MoveTank(OUTPUT_B, OUTPUT_C)
btn = Button()
log = DataLog('ms', 'step', 'angle', 'cm')

random.seed('ev3')
gyro.reset()
watch.start()
step = 0
while watch.value_secs < 12 and not btn.any():
    step += 1
    turn = random.randint(-40, 40)
    tank.on_for_degrees(20, -20, turn)
    if us.distance_centimeters > 25:
        tank.on_for_degrees(40, 40, 150)
    else:
        tank.on_for_degrees(-40, -40, 150)
    log.log(watch.value_ms, step, gyro.angle, round(us.distance_centimeters))
watch.stop()
log.close()

lines = str(log).splitlines()
print(lines[0])
print('steps logged:', len(lines) - 1 == step)
print('more than 8:', step > 8)
print('watch stopped:', not watch.is_started, watch.value_hms[2] >= 12 or btn.any())
times = [int(l.split(',')[0]) for l in lines[1:]]
print('in order:', times == sorted(times))
Sound().beep()
time.sleep(0.5)
os.remove(log.path)
