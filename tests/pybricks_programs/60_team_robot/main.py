#!/usr/bin/env pybricks-micropython
from pybricks.hubs import EV3Brick
from pybricks.parameters import Button, Color
from pybricks.tools import wait, StopWatch
from robot import *
import missions
import config
from menu import Menu

ev3.speaker.beep()
clock = StopWatch()

print("team", config.TEAM, "battery", ev3.battery.voltage())
if ev3.battery.voltage() < 7000:
    ev3.light.on(Color.RED)

missions.run01()
print("run01", clock.time(), base.distance(), base.angle(), gyro.angle())
clock.reset()
missions.run02()
print("run02", clock.time(), base.distance(), base.angle(), gyro.angle())

menu = Menu(ev3, [("Run 1", missions.run01), ("Run 2", missions.run02)])
while True:
    menu.step()
    wait(50)
