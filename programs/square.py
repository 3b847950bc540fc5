"""Drive a square with the pen down."""
# %%sim_magic -b Empty_Map -p

from ev3dev2.motor import OUTPUT_B, OUTPUT_C, MoveSteering, MoveTank, SpeedPercent

WHEEL_MM = 56
SPACING_MM = 180
SIDE_MM = 400
PI = 3.141592653589793

side_rotations = SIDE_MM / (PI * WHEEL_MM)
# To turn on the spot, each wheel runs along a circle whose diameter is the wheel spacing.
corner_rotations = SPACING_MM / WHEEL_MM / 4

tank = MoveTank(OUTPUT_B, OUTPUT_C)
steering = MoveSteering(OUTPUT_B, OUTPUT_C)

for side in range(4):
    tank.on_for_rotations(SpeedPercent(40), SpeedPercent(40), side_rotations)
    steering.on_for_rotations(100, SpeedPercent(20), corner_rotations)
    print("side", side + 1, "done")
