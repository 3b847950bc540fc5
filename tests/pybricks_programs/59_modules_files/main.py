#!/usr/bin/env pybricks-micropython
from pybricks.hubs import EV3Brick
from pybricks.ev3devices import (Motor, TouchSensor, ColorSensor,
                                 InfraredSensor, UltrasonicSensor, GyroSensor)
from pybricks.parameters import Port, Stop, Direction, Button, Color
from pybricks.tools import wait, StopWatch, DataLog
from pybricks.robotics import DriveBase
from pybricks.media.ev3dev import SoundFile, ImageFile
import time, utime, random, urandom
import ujson
import json
import ustruct, struct
import os, sys, uos
import math
import gc
import micropython
from ucollections import namedtuple, OrderedDict
from collections import deque

ev3 = EV3Brick()
motor = Motor(Port.A)

t = time.time()
t_ms = utime.ticks_ms()
time.sleep(0.25)
utime.sleep_ms(250)
utime.sleep_us(500)
dt = utime.ticks_diff(utime.ticks_ms(), t_ms)
print("half a second:", 495 < dt < 520, dt, time.time() - t)
print(time.ticks_add(5, 10), len(utime.localtime()) >= 8, time.ticks_us() > 0)

Step = namedtuple("Step", ("speed", "angle"))
steps = [Step(random.randint(100, 400), random.choice([90, 180, -90])) for i in range(3)]
for s in steps:
    motor.run_angle(s.speed, s.angle)
    print(motor.angle() - sum(x.angle for x in steps[:steps.index(s) + 1]))
print(0 <= random.random() < 1, 1 <= random.uniform(1, 2) <= 2, random.randrange(5) < 5, urandom.getrandbits(8) < 256)

conf = {"speed": 200, "kp": 1.25, "name": "robot", "list": [1, 2, 3]}
f = open("config.json", "w")
f.write(ujson.dumps(conf))
f.close()
with open('config.json') as fh:
    back = json.load(fh)
print(back == conf, back["kp"])

with open('calib.txt', 'a') as out:
    out.write('{},{}\n'.format(5, 87))
with open('calib.txt') as inp:
    for line in inp:
        black, white = line.strip().split(',')
print(int(black), int(white), 'calib.txt' in os.listdir(), uos.getcwd() != "")

data = ustruct.pack('<hBf', -300, 7, 1.5)
print(len(data), struct.unpack('<hBf', data), ustruct.calcsize('>IH'))
try:
    open('nothing_here.txt')
except OSError as e:
    print("no file", e.args[0])
d = OrderedDict()
d["a"] = 1
gc.collect()
print(sys.implementation.name, sys.platform, gc.mem_free() > 0, math.degrees(math.pi), list(d.keys()))
q = deque((), 5)
q.append(3)
print(q.popleft(), micropython.const(4))
os.remove('config.json')
sys.exit()
