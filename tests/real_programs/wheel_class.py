from ev3dev2.motor import LargeMotor


class Wheel:
    def __init__(self, port, name):
        self.motor = LargeMotor(port)
        self.name = name

    def spin(self):
        self.motor.on_for_degrees(20, 90, block=False)


left_wheel = Wheel('outC', 'links')
right_wheel = Wheel('outA', 'rechts')
for wheel in (left_wheel, right_wheel):
    wheel.spin()
left_wheel.motor.wait_until_not_moving()
print(left_wheel.motor.position)
