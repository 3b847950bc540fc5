#!/usr/bin/env micropython
# replay of a joystick recording (my PS3 pad, 10 Hz, -100..100)
import time
from ev3dev2.motor import MoveJoystick, OUTPUT_B, OUTPUT_C

RECORDING = """
0 0 5
0 40 10
20 60 10
50 50 5
0 0 3
-50 50 5
0 -60 15
100 0 6
-100 0 6
0 0 1
"""

joy = MoveJoystick(OUTPUT_B, OUTPUT_C)
for line in RECORDING.strip().splitlines():
    x, y, tenths = [int(p) for p in line.split()]
    joy.on(x, y, 100)
    time.sleep(tenths / 10)
    print('%4d %4d -> L %5d R %5d' % (x, y, joy.left_motor.speed_sp, joy.right_motor.speed_sp))
joy.off(brake=False)

print(joy.angle_to_speed_percentage(90))
print(joy.angle_to_speed_percentage(180))
print(joy.angle_to_speed_percentage(22.5))
