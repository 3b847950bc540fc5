import os
from ev3dev2.motor import LargeMotor, OUTPUT_A, OUTPUT_B
left = LargeMotor(os.environ.get('LEFT_MOTOR', OUTPUT_A))
right = LargeMotor(os.environ.get('RIGHT_MOTOR', OUTPUT_B))
left.on_for_rotations(20, 1, block=False)
right.on_for_rotations(20, 1)
print(left.address, right.address)
