import time
from ev3dev2.motor import MediumMotor, LargeMotor, OUTPUT_D, OUTPUT_B, OUTPUT_C


class Arm:
    def __init__(self):
        self.motor = MediumMotor(OUTPUT_D)

    def lower(self):
        self.motor.on(speed=15)
        self.motor.wait_until_not_moving()
        self.motor.off(brake=False)

    def lift(self):
        self.motor.on_for_degrees(30, -200)


arm = Arm()
arm.lower()
low = arm.motor.position
arm.lift()
print(low > 20, arm.motor.position < -100)
