from ev3dev2.motor import LargeMotor, OUTPUT_A, OUTPUT_B, OUTPUT_C
from ev3dev2.sensor.lego import TouchSensor
lift = LargeMotor(OUTPUT_A)
left, right = LargeMotor(OUTPUT_B), LargeMotor(OUTPUT_C)
top = TouchSensor('in1')
lift.on(20)
while not top.is_pressed:
    pass
lift.off()
print('at the top', top.is_pressed)
