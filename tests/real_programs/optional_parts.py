from ev3dev2 import DeviceNotFound
from ev3dev2.motor import MediumMotor, OUTPUT_A
from ev3dev2.sensor.lego import TouchSensor
try:
    arm = MediumMotor(OUTPUT_A)
except DeviceNotFound:
    arm = None
try:
    stop = TouchSensor('in1')
except Exception as error:
    print('no button', error)
    stop = None
print(arm is not None, stop is not None)
