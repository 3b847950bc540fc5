#!/usr/bin/env pybricks-micropython
from pybricks.ev3devices import Motor
from pybricks.iodevices import I2CDevice
from pybricks.parameters import Port
from pybricks.robotics import DriveBase


class Compass:
    def __init__(self, port):
        self.device = I2CDevice(port, 0x01)

    def heading(self):
        data = self.device.read(0x44, 2)
        return data[0] + 256 * data[1]


robot = DriveBase(Motor(Port.B), Motor(Port.C), 56, 114)
robot.straight(50)
compass = Compass(Port.S2)
print(compass.heading())
