#!/usr/bin/env pybricks-micropython
from pybricks.hubs import EV3Brick
from pybricks.ev3devices import (Motor, TouchSensor, ColorSensor,
                                 InfraredSensor, UltrasonicSensor, GyroSensor)
from pybricks.parameters import Port, Stop, Direction, Button, Color
from pybricks.tools import wait, StopWatch, DataLog
from pybricks.robotics import DriveBase
from pybricks.media.ev3dev import SoundFile, ImageFile
import math

ev3 = EV3Brick()
lm = Motor(Port.B, positive_direction=Direction.CLOCKWISE)
rm = Motor(Port.C, positive_direction=Direction.CLOCKWISE)
gs = GyroSensor(Port.S4, Direction.CLOCKWISE)
WHEEL = 56
TRACK = 114
robot = DriveBase(lm, rm, WHEEL, TRACK)

print(robot.settings())
robot.settings(straight_speed=180, straight_acceleration=300, turn_rate=100)
print("now", robot.settings())

gs.reset_angle(0)

for side in range(4):
    robot.straight(250)
    print("side", side, "dist", robot.distance(), "gyro", gs.angle())
    robot.turn(90)
    # fix what the turn missed
    error = 90 * (side + 1) - gs.angle()
    if abs(error) > 2:
        robot.turn(error)
    print("heading", robot.angle(), gs.angle(), "state", robot.state())

robot.stop()
robot.reset()
robot.drive(100, 45.5)
wait(2000)
d, s, a, r = robot.state()
print("drive 2s:", d, s, a, r)
robot.stop(Stop.BRAKE)

# turn with motors only
deg = 180 * TRACK / WHEEL
lm.run_angle(200, deg, Stop.HOLD, False)
rm.run_angle(-200, deg, Stop.HOLD, True)
print("left", lm.angle(), "right", rm.angle(), "gyro", gs.angle())

while gs.angle() % 360 > 5:
    lm.run(100)
    rm.run(-100)
lm.hold()
rm.hold()
print("end", gs.angle(), "rate", gs.speed(), math.pi * WHEEL)
ev3.speaker.beep(1000, 500)
