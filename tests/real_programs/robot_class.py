#!/usr/bin/env micropython
from ev3dev2.motor import LargeMotor, MediumMotor, OUTPUT_A, OUTPUT_C, OUTPUT_D, SpeedDPS
from ev3dev2.sensor.lego import GyroSensor, UltrasonicSensor


class Robot:
    """Our rescue robot."""

    def __init__(self, left_port=OUTPUT_A, right_port=OUTPUT_D):
        self.left = LargeMotor(left_port)
        self.right = LargeMotor(right_port)
        self.lift = MediumMotor(OUTPUT_C)
        self.gyro = GyroSensor()
        self.sonar = UltrasonicSensor()

    def forward(self, degrees):
        self.left.on_for_degrees(SpeedDPS(300), degrees, block=False)
        self.right.on_for_degrees(SpeedDPS(300), degrees)

    def up(self):
        self.lift.on_for_rotations(30, 2)


if __name__ == '__main__':
    robot = Robot()
    robot.forward(360)
    robot.up()
    print(robot.left.position, robot.right.position, robot.lift.position)
