#!/usr/bin/env pybricks-micropython
from pybricks.hubs import EV3Brick
from pybricks.ev3devices import Motor
from pybricks.parameters import Port, Stop
from pybricks.tools import wait

ev3 = EV3Brick()
m = Motor(Port.A)
ev3.screen.clear()
x, last_y, top = 0, 127, 0
m.run_time(600, 2000, Stop.BRAKE, False)
while not m.control.done():
    speed = m.speed()
    top = max(top, speed)
    y = 127 - speed // 8
    ev3.screen.draw_line(x, last_y, x + 2, y)
    x, last_y = x + 2, y
    wait(20)
print("max", top)
print("angle", 1020 <= m.angle() <= 1120)
print("points", x > 60)
