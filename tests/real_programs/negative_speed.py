# The motors are mounted backwards, so -50 is forward.
from ev3dev2.motor import MoveTank, OUTPUT_B, OUTPUT_C
tank = MoveTank(OUTPUT_B, OUTPUT_C)
FORWARD = -50
tank.on_for_seconds(FORWARD, FORWARD, 1)
print(tank.left_motor.position < 0)
