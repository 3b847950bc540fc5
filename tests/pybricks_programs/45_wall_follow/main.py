#!/usr/bin/env pybricks-micropython
from pybricks.hubs import EV3Brick
from pybricks.ev3devices import (Motor, TouchSensor, ColorSensor,
                                 InfraredSensor, UltrasonicSensor, GyroSensor)
from pybricks.parameters import Port, Stop, Direction, Button, Color
from pybricks.tools import wait, StopWatch, DataLog
from pybricks.robotics import DriveBase
from pybricks.media.ev3dev import SoundFile, ImageFile

ev3 = EV3Brick()
motorL = Motor(Port.B)
motorR = Motor(Port.C)
sonic = UltrasonicSensor(Port.S4)
bump = TouchSensor(Port.S1)
ir = InfraredSensor(Port.S2)
robot = DriveBase(motorL, motorR, 55.5, 120)


def drive_until(mm):
    """Drive till there is a wall"""
    robot.reset()
    robot.drive(150, 0)
    while sonic.distance() > mm and not bump.pressed():
        if robot.distance() > 1500:
            break
        wait(10)
    robot.stop(Stop.HOLD)
    return sonic.distance()


print("start at", sonic.distance(), "mm", sonic.distance(silent=True), sonic.presence())
print("stopped at", drive_until(200))
robot.turn(90)

TARGET = 150
GAIN = 0.4
last = 0
timer = StopWatch()
while timer.time() < 15000:
    if bump.pressed():
        ev3.speaker.play_file(SoundFile.OUCH)
        robot.straight(-80)
        robot.turn(45)
        continue
    dist = sonic.distance()
    err = dist - TARGET
    if err > 300:
        err = 300
    turn = -GAIN * err - 0.8 * (err - last)
    robot.drive(120, max(min(turn, 80), -80))
    last = err
    if ir.distance() < 20:
        print("IR sees something", ir.distance())
    wait(20)
robot.stop()
ev3.screen.print("Done:", robot.distance(), "mm")
print("Done:", robot.distance(), "mm", robot.angle())

# roomba forever
while True:
    motorL.run(300)
    motorR.run(300)
    while not bump.pressed() and sonic.distance() > 100:
        wait(10)
    motorL.stop()
    motorR.stop()
    motorL.run_time(-300, 800, Stop.COAST, False)
    motorR.run_time(-150, 800)
