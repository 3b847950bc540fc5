from ev3dev2.motor import MoveTank, OUTPUT_B, OUTPUT_C
from ev3dev2.sensor import INPUT_1, INPUT_2, INPUT_3
from ev3dev2.sensor.lego import ColorSensor
tank = MoveTank(OUTPUT_B, OUTPUT_C)
cs_mid, cs_left, cs_right = ColorSensor(INPUT_1), ColorSensor(INPUT_2), ColorSensor(INPUT_3)
print(cs_left.reflected_light_intensity, cs_mid.reflected_light_intensity, cs_right.reflected_light_intensity)
