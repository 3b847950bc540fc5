from ev3dev2.motor import LargeMotor, MoveTank, OUTPUT_B, OUTPUT_C, OUTPUT_A, OUTPUT_D, SpeedPercent


class Chassis(object):
    def __init__(self, left, right):
        self.tank = MoveTank(left, right)

    def go(self):
        self.tank.on_for_rotations(SpeedPercent(40), SpeedPercent(40), 1)


class Crane(object):
    def __init__(self, port):
        self.motor = LargeMotor(port)


chassis = Chassis(left=OUTPUT_D, right=OUTPUT_A)
crane = Crane(OUTPUT_B)
chassis.go()
crane.motor.on_for_degrees(20, 90)
print(crane.motor.position)
