#!/usr/bin/env pybricks-micropython
from pybricks.hubs import EV3Brick
from pybricks.ev3devices import (Motor, TouchSensor, ColorSensor,
                                 InfraredSensor, UltrasonicSensor, GyroSensor)
from pybricks.parameters import Port, Stop, Direction, Button, Color
from pybricks.tools import wait, StopWatch, DataLog
from pybricks.robotics import DriveBase
from pybricks.media.ev3dev import SoundFile, ImageFile
from threading import Thread
import _thread
import time

ev3 = EV3Brick()
left = Motor(Port.B)
right = Motor(Port.C)
arm = Motor(Port.A)
ir = InfraredSensor(Port.S4)
robot = DriveBase(left, right, wheel_diameter=56, axle_track=118)

running = True
lock = _thread.allocate_lock()
shared = {"ticks": 0, "buttons": 0}


def blink():
    colors = [Color.RED, Color.GREEN, Color.YELLOW, None]
    i = 0
    while running:
        ev3.light.on(colors[i % 4])
        i += 1
        with lock:
            shared["ticks"] += 1
        wait(250)


def arm_loop(speed, angle):
    for i in range(3):
        arm.run_angle(speed, angle)
        arm.run_angle(speed, -angle)
    print("arm finished", arm.angle())


def remote():
    while running:
        b = ir.buttons(1)
        if b:
            shared["buttons"] += 1
        d, h = ir.beacon(channel=1)
        if d is not None:
            print("beacon", d, h)
        time.sleep(0.1)


t = Thread(target=blink)
t.start()
_thread.start_new_thread(arm_loop, (300, 90))
Thread(target=remote).start()

sw = StopWatch()
robot.straight(300)
robot.turn(180)
robot.straight(300)
print("driven in", sw.time(), "ms, ticks", shared["ticks"])
while sw.time() < 9000:
    wait(100)
running = False
wait(500)
print("all done", shared, ir.keypad())
ev3.light.off()
