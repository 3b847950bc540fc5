from ev3dev2.motor import LargeMotor, OUTPUT_A, OUTPUT_D
from ev3dev2.sensor import INPUT_1, INPUT_2, INPUT_3
from ev3dev2.sensor.lego import ColorSensor
motors = [LargeMotor(port) for port in (OUTPUT_A, OUTPUT_D)]
row = []
for port in [INPUT_1, INPUT_2, INPUT_3]:
    row.append(ColorSensor(port))
for m in motors:
    m.run_direct(duty_cycle_sp=30)
print([s.reflected_light_intensity for s in row])
for m in motors:
    m.stop()
