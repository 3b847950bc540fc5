from ev3dev2.motor import LargeMotor, MediumMotor, OUTPUT_A, OUTPUT_B, OUTPUT_C, OUTPUT_D
motors = {
    'left': LargeMotor(OUTPUT_B),
    'right': LargeMotor(OUTPUT_A),
    'grip': MediumMotor(OUTPUT_C),
}
for name in ('left', 'right'):
    motors[name].on_for_degrees(20, 180, block=(name == 'right'))
motors['grip'].on_for_degrees(10, -30)
print([motors[name].position for name in ('left', 'right', 'grip')])
