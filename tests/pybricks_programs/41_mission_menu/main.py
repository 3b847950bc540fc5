#!/usr/bin/env pybricks-micropython
from pybricks.hubs import EV3Brick
from pybricks.ev3devices import (Motor, TouchSensor, ColorSensor,
                                 InfraredSensor, UltrasonicSensor, GyroSensor)
from pybricks.parameters import Port, Stop, Direction, Button, Color
from pybricks.tools import wait, StopWatch, DataLog
from pybricks.robotics import DriveBase
from pybricks.media.ev3dev import SoundFile, ImageFile


# This program requires LEGO EV3 MicroPython v2.0 or higher.
# Click "Open user guide" on the EV3 extension tab for more information.


# Create your objects here.
ev3 = EV3Brick()
left_motor = Motor(Port.B)
right_motor = Motor(Port.C)
armMotor = Motor(Port.A, Direction.COUNTERCLOCKWISE)
medium2 = Motor(Port.D)
gyro = GyroSensor(Port.S2)
color_left = ColorSensor(Port.S3)
robot = DriveBase(left_motor, right_motor, wheel_diameter=62.4, axle_track=121)

timer = StopWatch()


def gyro_turn(target, speed=60):
    gyro.reset_angle(0)
    wait(50)
    while abs(gyro.angle()) < abs(target):
        if target > 0:
            robot.drive(0, speed)
        else:
            robot.drive(0, -speed)
    robot.stop(Stop.BRAKE)


def gyro_straight(dist, speed):
    robot.reset()
    gyro.reset_angle(0)
    while robot.distance() < dist:
        correction = (0 - gyro.angle()) * 2.5
        robot.drive(speed, correction)
    robot.stop()


def mission1():
    # bench
    gyro_straight(400, 150)
    armMotor.run_angle(400, 120)
    gyro_turn(90)
    robot.straight(-100)
    armMotor.run_angle(400, -120, Stop.COAST, True)


def mission2():
    robot.stop()
    robot.settings(200, 100, 90, 90)
    robot.straight(300.0)
    robot.turn(-90)
    robot.stop()
    medium2.run_time(500, 1500, then=Stop.HOLD, wait=False)
    robot.straight(-150)


def mission3():
    while color_left.reflection() > 15:
        robot.drive(100, 0)
    robot.stop()
    ev3.speaker.beep()


missions = [("Bench", mission1), ("Step Counter", mission2), ("Line", mission3)]
current = 0

ev3.speaker.beep()
ev3.screen.clear()
ev3.screen.draw_text(10, 50, "<- " + missions[current][0] + " ->")
ev3.light.on(Color.ORANGE)

while True:
    pressed = ev3.buttons.pressed()
    if Button.RIGHT in pressed:
        current = (current + 1) % len(missions)
        ev3.screen.clear()
        ev3.screen.draw_text(10, 50, "<- " + missions[current][0] + " ->")
        while any(ev3.buttons.pressed()):
            pass
    elif Button.LEFT in pressed:
        current = (current - 1) % len(missions)
        ev3.screen.clear()
        ev3.screen.draw_text(10, 50, "<- " + missions[current][0] + " ->")
        wait(300)
    elif Button.CENTER in pressed:
        ev3.light.on(Color.GREEN)
        timer.reset()
        missions[current][1]()
        print(missions[current][0], "took", timer.time() / 1000, "s")
        ev3.light.on(Color.ORANGE)
        current = min(current + 1, len(missions) - 1)
