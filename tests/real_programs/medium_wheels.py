from ev3dev2.motor import MediumMotor, MoveTank, OUTPUT_A, OUTPUT_B, OUTPUT_C
tank = MoveTank(OUTPUT_A, OUTPUT_B, motor_class=MediumMotor)
blade = MediumMotor(OUTPUT_C)
tank.on_for_rotations(40, 40, 2)
blade.on_for_rotations(100, 3)
print(tank.left_motor.driver_name, blade.position)
