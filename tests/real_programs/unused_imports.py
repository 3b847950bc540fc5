from ev3dev2.motor import LargeMotor, MediumMotor, MoveTank, OUTPUT_A, OUTPUT_B, OUTPUT_C, OUTPUT_D
from ev3dev2.sensor.lego import ColorSensor, InfraredSensor, TouchSensor
tank = MoveTank(OUTPUT_B, OUTPUT_C)


class NeverUsed:
    def __init__(self):
        self.arm = MediumMotor(OUTPUT_A)
        self.stop = TouchSensor('in1')


tank.on_for_rotations(20, 20, 0.5)
print(ColorSensor('in2').color_name)
