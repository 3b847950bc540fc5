# Our robot drives with the motors at the back: C is left.
from ev3dev2.motor import MoveTank, OUTPUT_B, OUTPUT_C
tank = MoveTank(OUTPUT_C, OUTPUT_B)
tank.on_for_rotations(30, 10, 1)
print(tank.left_motor.address)
