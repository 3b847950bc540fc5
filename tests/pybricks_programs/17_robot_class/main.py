#!/usr/bin/env pybricks-micropython
from pybricks.parameters import Port
from lib.robot import Robot

robot = Robot(Port.A, Port.D, Port.S2, 62.4, 145)
robot.straight(300)
robot.turn(-90)
robot.straight(-100)
robot.end()
