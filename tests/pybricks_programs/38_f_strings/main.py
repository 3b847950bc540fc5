#!/usr/bin/env pybricks-micropython
from pybricks.ev3devices import Motor, GyroSensor
from pybricks.parameters import Port
from pybricks.robotics import DriveBase

m = Motor(Port.A)
gyro = GyroSensor(Port.S4)
robot = DriveBase(Motor(Port.B), Motor(Port.C), 56, 114)
m.run_target(360, 180)
print(f"Motor {m.angle()} degrees")
print(f"state {robot.state()}")
robot.turn(90)
before = gyro.angle()
gyro.speed()
print(f"gyro bug: angle {before // 10 * 10} then {gyro.angle()}")
