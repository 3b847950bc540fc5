from ev3dev2.motor import LargeMotor, MediumMotor
from ev3dev2.sensor.lego import GyroSensor, InfraredSensor

mA = LargeMotor('outA')
mB = LargeMotor('outB')
mD = MediumMotor('outD')
ir = InfraredSensor('in1')
gy = GyroSensor('in2')
mA.run_timed(time_sp=500, speed_sp=300)
mB.run_timed(time_sp=500, speed_sp=300)
mA.wait_while('running')
print('far' if ir.proximity > 90 else 'near', abs(gy.angle) < 2)
