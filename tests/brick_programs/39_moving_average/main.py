#!/usr/bin/env python3
import random
import statistics
import struct
from collections import Counter, deque, namedtuple
from time import sleep

from ev3dev2.motor import MoveSteering, OUTPUT_B, OUTPUT_C
from ev3dev2.sensor import INPUT_1, INPUT_2
from ev3dev2.sensor.lego import ColorSensor, UltrasonicSensor

Sample = namedtuple('Sample', 'n dist refl')
RECORD = struct.Struct('<HfB')


class MovingAverage:
    def __init__(self, size):
        self.window = deque(maxlen=size)

    def __call__(self, value):
        self.window.append(value)
        return sum(self.window) / len(self.window)

    def median(self):
        return statistics.median(self.window)


us = UltrasonicSensor(INPUT_1)
cs = ColorSensor(INPUT_2)
steer = MoveSteering(OUTPUT_B, OUTPUT_C)
avg = MovingAverage(8)
rnd = random.Random(2024)
colours = Counter()
blob = bytearray()

steer.on(0, 20)
for n in range(40):
    d = us.distance_centimeters
    noisy = d + rnd.gauss(0, 2)
    smooth = avg(noisy)
    s = Sample(n, smooth, cs.reflected_light_intensity)
    blob += RECORD.pack(*s)
    if n % 10 == 9:
        print('%2d smooth-median small: %s' % (n, abs(smooth - avg.median()) < 5))
    sleep(0.05)
steer.off()
for _ in range(5):
    colours[cs.color_name] += 1

with open('/tmp/robot_samples.bin', 'wb') as f:
    f.write(blob)
with open('/tmp/robot_samples.bin', 'rb') as f:
    data = f.read()
samples = [Sample(*t) for t in RECORD.iter_unpack(data)]
print(len(data), 'bytes', len(samples), 'samples, last n', samples[-1].n)
print('came closer:', samples[5].dist - samples[-1].dist > 5)
print(colours.most_common(1))
cs.mode = cs.MODE_COL_REFLECT
print('bin_data == value:', abs(cs.bin_data('<b')[0] - cs.value()) <= 1, cs.bin_data_format)
rgb = cs.rgb
print('rgb', len(rgb), all(0 <= c <= 255 for c in rgb), 'raw', cs.mode)
