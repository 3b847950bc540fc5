from ev3dev2.motor import MoveSteering, OUTPUT_A, OUTPUT_B
from ev3dev2.sensor.lego import GyroSensor
drive = MoveSteering(OUTPUT_A, OUTPUT_B)
gyro = GyroSensor('in2')
