from ev3dev2.sensor import INPUT_1, INPUT_4
from ev3dev2.sensor.lego import TouchSensor
from ev3dev2.motor import MoveTank, OUTPUT_B, OUTPUT_C
bump_left = TouchSensor(INPUT_1)
bump_right = TouchSensor(INPUT_4)
tank = MoveTank(OUTPUT_B, OUTPUT_C)
tank.on(50, 50)
while not (bump_left.is_pressed or bump_right.is_pressed):
    pass
tank.off()
print('bump', bump_left.is_pressed, bump_right.is_pressed)
