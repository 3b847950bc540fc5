#!/usr/bin/env pybricks-micropython
from pybricks.hubs import EV3Brick
from pybricks.ev3devices import Motor, ColorSensor
from pybricks.iodevices import AnalogSensor, UARTDevice, LUMPDevice, I2CDevice, DCMotor, Ev3devSensor
from pybricks.parameters import Port, Color
from pybricks.tools import wait
import ustruct

ev3 = EV3Brick()
motor = Motor(Port.A)
motor.run_time(200, 500)
print("motor", motor.angle())

# pixy camera
pixy = I2CDevice(Port.S2, 0x54)
pixy.write(reg=0xAE, data=bytes([0xC1, 0x0E, 0x00]))
answer = pixy.read(0x50, length=6)
print(ustruct.unpack('<HHH', answer))
while True:
    n, x = ustruct.unpack('<HI', pixy.read(0x51, 6))
    if x > 150:
        motor.run(100)
    else:
        motor.run(-100)
    wait(50)
