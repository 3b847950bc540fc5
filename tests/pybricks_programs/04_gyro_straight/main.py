#!/usr/bin/env pybricks-micropython
from pybricks.hubs import EV3Brick
from pybricks.ev3devices import Motor, GyroSensor
from pybricks.parameters import Port, Stop, Direction
from pybricks.tools import wait
from pybricks.robotics import DriveBase

ev3 = EV3Brick()
left = Motor(Port.A, Direction.CLOCKWISE)
right = Motor(Port.D, Direction.CLOCKWISE)
gyro = GyroSensor(Port.S4, Direction.CLOCKWISE)
robot = DriveBase(left, right, 62.4, 120)
robot.reset()
gyro.reset_angle(0)

PROPORTIONAL_GAIN = 1.1
while robot.distance() < 600:
    angle_correction = -1 * (PROPORTIONAL_GAIN * gyro.angle())
    robot.drive(150, angle_correction)
robot.stop(Stop.BRAKE)
print("done", robot.distance() // 10 * 10, gyro.angle())
