#!/usr/bin/env pybricks-micropython
from pybricks.parameters import Button
from pybricks.tools import wait

from missions import m1_crane, m2_park
from robot import ev3

MISSIONS = [m1_crane, m2_park]
choice = 0


def draw():
    ev3.screen.clear()
    for i, m in enumerate(MISSIONS):
        ev3.screen.print(">" if i == choice else " ", m.NAME)


draw()
running = True
while running:
    buttons = ev3.buttons.pressed()
    if Button.DOWN in buttons or Button.UP in buttons:
        choice = (choice + (1 if Button.DOWN in buttons else -1)) % len(MISSIONS)
        draw()
        while any(ev3.buttons.pressed()):
            wait(10)
    elif Button.CENTER in buttons:
        print(choice + 1, MISSIONS[choice].NAME)
        MISSIONS[choice].run()
        draw()
    elif Button.LEFT_UP in buttons:
        running = False
    wait(10)
print("last run")
