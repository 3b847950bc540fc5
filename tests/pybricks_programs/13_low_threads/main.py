#!/usr/bin/env pybricks-micropython
import _thread
import utime
from pybricks.hubs import EV3Brick
from pybricks.parameters import Color
from pybricks.tools import wait

ev3 = EV3Brick()
lock = _thread.allocate_lock()
count = 0


def counter(step):
    global count
    while True:
        with lock:
            count += step
        utime.sleep_ms(100)


_thread.start_new_thread(counter, (1,))

for i in range(10):
    ev3.light.on(Color.RED)
    wait(200)
    ev3.light.off()
    wait(100)
with lock:
    print("counted", 29 <= count <= 31)
