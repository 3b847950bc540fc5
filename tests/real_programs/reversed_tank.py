from ev3dev2.motor import MoveTank, OUTPUT_B, OUTPUT_C


class Truck(MoveTank):
    def __init__(self):
        MoveTank.__init__(self, OUTPUT_B, OUTPUT_C)
        self.set_polarity('inversed')


truck = Truck()
truck.on_for_rotations(30, 30, 1)
print(truck.left_motor.polarity)
