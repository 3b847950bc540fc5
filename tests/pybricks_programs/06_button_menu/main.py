#!/usr/bin/env pybricks-micropython
from pybricks.hubs import EV3Brick
from pybricks.ev3devices import (Motor, TouchSensor, ColorSensor,
                                 InfraredSensor, UltrasonicSensor, GyroSensor)
from pybricks.parameters import Port, Stop, Direction, Button, Color
from pybricks.tools import wait, StopWatch, DataLog
from pybricks.robotics import DriveBase
from pybricks.media.ev3dev import SoundFile, ImageFile

ev3 = EV3Brick()
robot = DriveBase(Motor(Port.B), Motor(Port.C), 55.5, 104)

def showMenu():
    ev3.screen.clear()
    ev3.screen.draw_text(10, 10, "LEFT  - mission 1")
    ev3.screen.draw_text(10, 40, "RIGHT - mission 2")
    ev3.screen.draw_text(10, 70, "CENTER - exit")
    ev3.light.on(Color.ORANGE)

def missionLeft():
    ev3.light.on(Color.GREEN)
    print("mission left")
    robot.straight(200)

def missionRight():
    ev3.light.on(Color.GREEN)
    print("mission right")
    robot.turn(90)

showMenu()
while True:
    pressed = ev3.buttons.pressed()
    if Button.LEFT in pressed:
        missionLeft()
        showMenu()
    elif Button.RIGHT in pressed:
        missionRight()
        showMenu()
    elif Button.CENTER in pressed:
        break
    wait(50)

print("bye")
ev3.light.off()
