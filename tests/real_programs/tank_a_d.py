#!/usr/bin/env python3
from ev3dev2.motor import MoveTank, OUTPUT_A, OUTPUT_D
tank = MoveTank(OUTPUT_A, OUTPUT_D)
tank.on_for_rotations(30, 30, 1)
print(tank.left_motor.address, tank.left_motor.position)
