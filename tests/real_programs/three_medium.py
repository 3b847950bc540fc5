from ev3dev2.motor import LargeMotor, MediumMotor, MoveTank, OUTPUT_A, OUTPUT_B, OUTPUT_C
grip, wrist, elbow = MediumMotor(OUTPUT_A), MediumMotor(OUTPUT_B), MediumMotor(OUTPUT_C)
for joint in (grip, wrist, elbow):
    joint.on_for_degrees(20, 40)
print([joint.position for joint in (grip, wrist, elbow)])
