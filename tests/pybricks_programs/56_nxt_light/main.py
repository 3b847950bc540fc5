#!/usr/bin/env pybricks-micropython
from pybricks.hubs import EV3Brick
from pybricks.ev3devices import Motor, TouchSensor
from pybricks.nxtdevices import LightSensor, SoundSensor
from pybricks.nxtdevices import UltrasonicSensor as NXTUltra
from pybricks.parameters import Port
from pybricks.robotics import DriveBase
from pybricks.tools import wait

ev3 = EV3Brick()
robot = DriveBase(Motor(Port.B), Motor(Port.C), 56, 110)
light = LightSensor(Port.S3)
sound = SoundSensor(Port.S2)
ultra = NXTUltra(Port.S4)

while sound.intensity() < 40:
    wait(20)
while ultra.distance() > 200:
    robot.drive(100, (light.reflection() - 35) * 1.5)
robot.stop()
