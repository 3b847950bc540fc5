#!/usr/bin/env pybricks-micropython
from pybricks.hubs import EV3Brick
from pybricks.ev3devices import Motor, GyroSensor, ColorSensor
from pybricks.parameters import Port, Stop, Direction
from pybricks.tools import wait, StopWatch
from pybricks.robotics import DriveBase

ev3 = EV3Brick()
l = Motor(Port.B, Direction.COUNTERCLOCKWISE)
r = Motor(Port.C, Direction.COUNTERCLOCKWISE)
lift = Motor(Port.A, Direction.CLOCKWISE, [[12, 36], [20, 16]])

print("limits", lift.control.limits(), "pid", lift.control.pid())
print("tol", lift.control.target_tolerances(), lift.control.stall_tolerances(), lift.control.scale)
lift.control.limits(400, 800, 60)
lift.control.pid(kp=500, kd=6)
lift.control.target_tolerances(speed=30, position=5)
lift.control.stall_tolerances(40, time=300)
print("limits", lift.control.limits(), "pid", lift.control.pid())

lift.run_target(1000, 90)
print(lift.angle(), lift.control.done(), lift.control.stalled())
lift.run_angle(500, -90.7, then=Stop.COAST)
print(lift.angle(), lift.control.done())

robot = DriveBase(l, r, 68.8, 135)
robot.distance_control.limits(300, 400)
robot.heading_control.pid(kp=12)
print("dist ctl", robot.distance_control.limits(), robot.distance_control.pid())
print("head ctl", robot.heading_control.limits(), robot.heading_control.target_tolerances())
robot.settings(250, 200, 120, 200)
w = StopWatch()
robot.straight(-200)
print("back", robot.distance(), w.time())
try:
    robot.settings(straight_speed=100)
    print("changed at once?")
except OSError as ex:
    print("busy:", ex)
robot.stop()
robot.settings(straight_speed=100)
w.reset()
robot.straight(200)
print("forth", robot.distance(), w.time(), robot.distance_control.done(), robot.distance_control.stalled())
robot.turn(360)
print("angle", robot.angle(), "motors", l.angle(), r.angle())
robot.stop()

l.log.start(2000)
l.run_angle(300, 180)
rows = l.log.get()
print("log", type(rows))
l.log.stop()
