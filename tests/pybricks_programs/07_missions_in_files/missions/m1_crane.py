from pybricks.parameters import Stop

from robot import arm, base, fast, slow

NAME = "crane"


def run():
    fast()
    base.straight(400)
    arm.run_angle(300, 120, Stop.HOLD)
    print("arm", arm.angle())
    arm.run_angle(300, -120)
    slow()
    base.straight(-400)
    base.stop()
