from ev3dev2.motor import LargeMotor, OUTPUT_A, OUTPUT_B, OUTPUT_C, OUTPUT_D
motors = [LargeMotor(p) for p in (OUTPUT_A, OUTPUT_B, OUTPUT_C, OUTPUT_D)]
for m in motors:
    m.on_for_degrees(20, 90, block=False)
for m in motors:
    m.wait_until_not_moving()
print(len(motors))
