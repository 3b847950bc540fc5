#!/usr/bin/env pybricks-micropython
from pybricks.hubs import EV3Brick
from pybricks.ev3devices import (Motor, TouchSensor, ColorSensor,
                                 InfraredSensor, UltrasonicSensor, GyroSensor)
from pybricks.parameters import Port, Stop, Direction, Button, Color
from pybricks.tools import wait, StopWatch, DataLog
from pybricks.robotics import DriveBase
from pybricks.media.ev3dev import SoundFile, ImageFile

ev3 = EV3Brick()
left = Motor(Port.A)
right = Motor(Port.D)
cs_l = ColorSensor(Port.S1)
cs_r = ColorSensor(Port.S4)
robot = DriveBase(left, right, 81.6, 142)


class PIDLine:
    def __init__(self, kp, ki=0, kd=0):
        self.kp, self.ki, self.kd = kp, ki, kd
        self.integral = 0
        self.last = 0

    def follow(self, time, speed=120):
        sw = StopWatch()
        while sw.time() < time:
            error = cs_l.reflection() - 45
            self.integral = self.integral + error
            derivative = error - self.last
            out = self.kp * error + self.ki * self.integral + self.kd * derivative
            robot.drive(speed, out)
            self.last = error
            if cs_r.color() == Color.BLACK or Button.UP in ev3.buttons.pressed():
                ev3.light.on(Color.RED)
                break
        robot.stop()
        return sw.time()


def square_up(speed=80):
    # align on a line with two sensors, but not longer than 4 s
    watch = StopWatch()
    l_done = r_done = False
    left.run(speed)
    right.run(speed)
    while not (l_done and r_done) and watch.time() < 4000:
        if cs_l.reflection() < 20:
            left.hold()
            l_done = True
        if cs_r.reflection() < 20:
            right.hold()
            r_done = True
    left.brake()
    right.brake()


def calibrate():
    lo, hi = 100, 0
    robot.reset()
    robot.drive(50, 0)
    while robot.distance() < 100:
        v = cs_l.reflection()
        lo = min(lo, v)
        hi = max(hi, v)
    robot.stop()
    return lo, hi


print("Calibrated: %d - %d" % calibrate())
pid = PIDLine(0.9, 0.0005, 4)
t = pid.follow(8000)
print("followed for", t, "ms")
square_up()
print("colors:", cs_l.color(), cs_r.color(), cs_l.rgb(), cs_r.ambient())
(r, g, b) = cs_l.rgb()
print(r + g + b, max(r, g, b))
robot.straight(-100)
ev3.speaker.beep(frequency=880, duration=200)
