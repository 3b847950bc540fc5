from hardware import *

drive.on_for_rotations(0, 30, 1)
print(gyro.angle == 0)
