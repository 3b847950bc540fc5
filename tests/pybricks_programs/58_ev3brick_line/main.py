#!/usr/bin/env pybricks-micropython

from pybricks import ev3brick as brick
from pybricks.ev3devices import Motor, ColorSensor, GyroSensor, TouchSensor
from pybricks.parameters import Port, Stop, Direction, Button, Color, ImageFile, SoundFile
from pybricks.tools import print, wait, StopWatch
from pybricks.robotics import DriveBase
import time

motor_l = Motor(Port.B)
motor_r = Motor(Port.C)
cl = ColorSensor(Port.S2)
cr = ColorSensor(Port.S3)
gyro = GyroSensor(Port.S1)


def tank(l, r):
    motor_l.run(l)
    motor_r.run(r)


def spin(deg):
    start = gyro.angle()
    while abs(gyro.angle() - start) < deg - 5:
        tank(120, -120)
    motor_l.brake()
    motor_r.brake()


brick.display.text("Line", (10, 20))
brick.light(Color.GREEN)
t0 = time.time()
while time.time() - t0 < 10:
    diff = cl.reflection() - cr.reflection()
    tank(150 + diff * 2, 150 - diff * 2)
    if Button.LEFT in brick.buttons():
        break
    if cl.color() == Color.GREEN and cr.color() == Color.GREEN:
        brick.sound.beep()
        break
motor_l.stop()
motor_r.stop()
print("10 s:", motor_l.angle(), motor_r.angle())
spin(90)
print("gyro", gyro.angle())
while not Button.CENTER in brick.buttons():
    brick.display.clear()
    brick.display.text(str(cl.reflection()) + " " + str(cr.color()), (0, 60))
    wait(200)
