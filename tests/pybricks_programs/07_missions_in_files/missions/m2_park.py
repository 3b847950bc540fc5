from robot import base, fast

NAME = "park"


def run():
    fast()
    base.straight(150)
    base.turn(-90)
    base.stop()
