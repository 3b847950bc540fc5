from ev3dev2.motor import LargeMotor, MediumMotor, MotorSet, OUTPUT_A, OUTPUT_C, OUTPUT_D
every = MotorSet({OUTPUT_A: LargeMotor, OUTPUT_D: LargeMotor, OUTPUT_C: MediumMotor})
every.on_for_degrees(20, 50) if hasattr(every, 'on_for_degrees') else every.run_timed(time_sp=300, speed_sp=200)
print(sorted(every.motors))
