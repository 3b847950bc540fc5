from ev3dev2.motor import MoveDifferential, OUTPUT_B, OUTPUT_C, SpeedPercent
from ev3dev2.wheel import Wheel

TRACK = 115.5


class BigWheel(Wheel):
    """81.6 x 15 motorcycle wheel"""

    def __init__(self):
        Wheel.__init__(self, 81.6, 15)


base = MoveDifferential(OUTPUT_B, OUTPUT_C, BigWheel, TRACK)
base.on_for_distance(SpeedPercent(20), 200)
print(round(base.left_motor.position, -1))
