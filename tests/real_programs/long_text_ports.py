from ev3dev2.motor import MoveSteering
from ev3dev2.sensor.lego import UltrasonicSensor
drive = MoveSteering('ev3-ports:outD', 'ev3-ports:outC')
eyes = UltrasonicSensor('ev3-ports:in4')
drive.on_for_seconds(0, 20, 1)
print(eyes.address, eyes.distance_centimeters > 20)
