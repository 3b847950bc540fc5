from ev3dev.auto import OUTPUT_B, OUTPUT_C, OUTPUT_A, MediumMotor
from ev3dev.helper import RemoteControlledTank


class Tracker(RemoteControlledTank):
    def __init__(self, medium_motor, left_motor, right_motor):
        RemoteControlledTank.__init__(self, left_motor, right_motor, polarity='normal')
        self.medium_motor = MediumMotor(medium_motor)


trackor = Tracker(OUTPUT_A, OUTPUT_B, OUTPUT_C)
print('ready')
