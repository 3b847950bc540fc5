#!/usr/bin/env pybricks-micropython
from pybricks.hubs import EV3Brick
from pybricks.ev3devices import Motor
from pybricks.parameters import Port, Stop, Direction
from pybricks.tools import wait

ev3 = EV3Brick()
gripper_motor = Motor(Port.A)

# First rotate the motor until it stalls. Stalling means that it
# cannot move any further. This position corresponds to the closed
# position. Then rotate the motor by 90 degrees such that the
# gripper is open.
closed = gripper_motor.run_until_stalled(200, then=Stop.COAST, duty_limit=50)
print("closed at", type(closed) is int)
gripper_motor.reset_angle(0)
gripper_motor.run_target(200, -90)
print("open", gripper_motor.angle())
for i in range(2):
    angle = gripper_motor.run_until_stalled(200, then=Stop.HOLD, duty_limit=50)
    print("grip", -15 <= angle <= 15)
    wait(500)
    gripper_motor.run_target(200, -90)
print("end", gripper_motor.angle())
