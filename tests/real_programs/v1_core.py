from ev3dev.core import LargeMotor, Motor, Sensor
from ev3dev.auto import OUTPUT_A, OUTPUT_B

m1, m2 = LargeMotor(OUTPUT_A), LargeMotor(OUTPUT_B)
s = Sensor('in1')
s.mode = 'US-DIST-CM'
arm = Motor('outC')
print(s.value())
