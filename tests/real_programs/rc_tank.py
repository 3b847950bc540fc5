from ev3dev2.control.rc_tank import RemoteControlledTank
from ev3dev2.motor import MediumMotor, OUTPUT_A, OUTPUT_B, OUTPUT_C
tank = RemoteControlledTank(OUTPUT_B, OUTPUT_C)
gun = MediumMotor(OUTPUT_A)
gun.on_for_rotations(50, 1)
print(tank.remote.driver_name)
