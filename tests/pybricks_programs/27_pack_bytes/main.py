#!/usr/bin/env pybricks-micropython
import ustruct as struct
import utime as time
import ubinascii
from micropython import const
from pybricks.hubs import EV3Brick

START = const(1)
ev3 = EV3Brick()
packet = struct.pack("<Bhh", START, 500, -100)
print(packet)
print(struct.unpack("<Bhh", packet))
print("crc", sum(packet) & 0xFF, ubinascii.hexlify(packet).decode())
t0 = time.ticks_ms()
time.sleep_ms(200)
time.sleep(0.05)
print("waited", 250 <= time.ticks_diff(time.ticks_ms(), t0) <= 255)
try:
    from ucollections import namedtuple
    P = namedtuple("P", ("x", "y", "z"))
    print("sum", sum(P(1, 2, 3)))
except ImportError:
    print("no ucollections")
