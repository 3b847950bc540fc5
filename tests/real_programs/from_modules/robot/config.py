from ev3dev2.motor import OUTPUT_A, OUTPUT_B, OUTPUT_D
from ev3dev2.sensor import INPUT_1

LEFT, RIGHT, FORK = OUTPUT_A, OUTPUT_D, OUTPUT_B
EYE = INPUT_1
