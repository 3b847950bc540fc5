from ev3dev2.motor import LargeMotor, Motor, OUTPUT_A, OUTPUT_B
left = LargeMotor(OUTPUT_A)
right = LargeMotor(OUTPUT_B)
for motor in (left, right):
    motor.polarity = Motor.POLARITY_INVERSED
left.on_for_rotations(30, 2, block=False)
right.on_for_rotations(30, 2)
print(left.position, left.polarity)
