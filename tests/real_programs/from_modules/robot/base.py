from ev3dev2.motor import MoveTank
from ev3dev2.sensor.lego import ColorSensor
from .config import LEFT, RIGHT, EYE


class Base:
    def __init__(self):
        self.tank = MoveTank(LEFT, RIGHT)
        self.eye = ColorSensor(EYE)

    def forward(self):
        self.tank.on_for_rotations(30, 30, 1)


if __name__ == '__main__':
    from ev3dev2.sensor.lego import TouchSensor
    print(TouchSensor('in4').is_pressed)
