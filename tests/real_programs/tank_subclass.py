from ev3dev2.motor import MoveTank, MediumMotor, OUTPUT_A, OUTPUT_B, OUTPUT_C, SpeedPercent


class Rover(MoveTank):
    def __init__(self, left_motor_port, right_motor_port, grabber=OUTPUT_A):
        super().__init__(left_motor_port, right_motor_port)
        self.grabber = MediumMotor(grabber)

    def square(self):
        for _ in range(2):
            self.on_for_rotations(SpeedPercent(30), SpeedPercent(30), 0.5)


rover = Rover(OUTPUT_B, OUTPUT_C)
rover.square()
rover.grabber.on_for_degrees(30, 120)
print(rover.grabber.position)
