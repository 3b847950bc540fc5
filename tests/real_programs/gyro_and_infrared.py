from ev3dev2.motor import MoveSteering, OUTPUT_B, OUTPUT_C
from ev3dev2.sensor.lego import GyroSensor, InfraredSensor
steer = MoveSteering(OUTPUT_B, OUTPUT_C)
gyro = GyroSensor()
ir = InfraredSensor()
gyro.reset()
steer.on_for_rotations(100, 20, 0.5)
print(gyro.angle > 30, ir.beacon() if hasattr(ir, 'nothing') else ir.proximity)
