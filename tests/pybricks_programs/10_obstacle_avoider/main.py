#!/usr/bin/env pybricks-micropython

from pybricks.hubs import EV3Brick
from pybricks.ev3devices import Motor, UltrasonicSensor
from pybricks.parameters import Port
from pybricks.tools import wait
from pybricks.robotics import DriveBase
from pybricks.media.ev3dev import SoundFile

# Initialize the EV3 Brick.
ev3 = EV3Brick()

# Initialize the Ultrasonic Sensor. It is used to detect
# obstacles as the robot drives around.
obstacle_sensor = UltrasonicSensor(Port.S4)

# Initialize two motors with default settings on Port B and Port C.
left_motor = Motor(Port.B)
right_motor = Motor(Port.C)
robot = DriveBase(left_motor, right_motor, wheel_diameter=55.5, axle_track=104)

ev3.speaker.beep()
count = 0

# The following loop makes the robot drive forward until it detects an
# obstacle. Then it backs up, turns around, and continues driving.
while count < 3:
    robot.drive(200, 0)

    while obstacle_sensor.distance() > 300:
        wait(10)

    robot.straight(-300)
    robot.turn(120)
    count = count + 1
    print("obstacle", count)
robot.stop()
