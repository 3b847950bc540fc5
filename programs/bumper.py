"""Drive until the bumper touches, wave with the arm, and go back."""
# %%sim_magic_imports -r Explorer -b Empty_Map -o Wall -x 900 -y 600 --solid

from ev3dev2.motor import OUTPUT_A, MediumMotor
from ev3dev2.sensor.lego import TouchSensor

tank_drive = MoveTank(OUTPUT_B, OUTPUT_C)
arm = MediumMotor(OUTPUT_A)
bumper = TouchSensor(INPUT_1)

tank_drive.on(SpeedPercent(30), SpeedPercent(30))
bumper.wait_for_pressed()
tank_drive.off()
print("Rotations: " + str(round(tank_drive.left_motor.rotations, 2)))

arm.on_for_degrees(SpeedPercent(40), 90)
arm.on_for_degrees(SpeedPercent(40), -90)
tank_drive.on_for_rotations(SpeedPercent(-30), SpeedPercent(-30), 1)
print("Arm: " + str(arm.position))
