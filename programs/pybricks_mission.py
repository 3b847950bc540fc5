#!/usr/bin/env pybricks-micropython
"""Missions of a team: choose by a button, drive, and turn by the gyro (Pybricks)."""
# %sim_magic -b Empty_Map --obstacles Wall -x 400 -y 600 -a 0

from pybricks.hubs import EV3Brick
from pybricks.ev3devices import Motor, TouchSensor, ColorSensor, InfraredSensor, UltrasonicSensor, GyroSensor
from pybricks.parameters import Port, Stop, Direction, Button, Color
from pybricks.tools import wait, StopWatch, DataLog
from pybricks.robotics import DriveBase
from pybricks.media.ev3dev import SoundFile, ImageFile

ev3 = EV3Brick()
left_motor = Motor(Port.B)
right_motor = Motor(Port.C)
robot = DriveBase(left_motor, right_motor, wheel_diameter=56, axle_track=180)
robot.settings(200, 400, 90, 180)
gyro = GyroSensor(Port.S4)
eyes = UltrasonicSensor(Port.S1)


def gyro_turn(angle):
    # A positive angle turns right. The last degrees are slow, so that the robot stops in time.
    start = gyro.angle()
    direction = 1 if angle > 0 else -1
    rest = abs(angle)
    while rest > 0:
        robot.drive(0, direction * max(15, min(90, 2 * rest)))
        wait(10)
        rest = abs(angle) - abs(gyro.angle() - start)
    robot.stop()


def to_the_wall():
    robot.reset()
    robot.drive(150, 0)
    while eyes.distance() > 200:
        wait(10)
    robot.stop()
    way = robot.distance()
    print("Wall after: " + str(way))
    gyro_turn(180)
    robot.straight(way)
    gyro_turn(180)


def round_the_corner():
    robot.straight(300)
    gyro_turn(90)
    robot.straight(200)
    robot.straight(-200)
    gyro_turn(-90)
    robot.straight(-300)


def chosen_missions():
    # The left or the right button chooses a mission. After two seconds without one, both run.
    ev3.screen.print("left: wall")
    ev3.screen.print("right: corner")
    ev3.light.on(Color.ORANGE)
    watch = StopWatch()
    while watch.time() < 2000:
        pressed = ev3.buttons.pressed()
        if Button.LEFT in pressed:
            return [to_the_wall]
        if Button.RIGHT in pressed:
            return [round_the_corner]
        wait(10)
    return [to_the_wall, round_the_corner]


for mission in chosen_missions():
    ev3.light.on(Color.GREEN)
    ev3.speaker.beep()
    mission()
print("Gyro: " + str(gyro.angle()))
