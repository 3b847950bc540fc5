from enum import Enum
from ev3dev2.motor import MoveSteering, MediumMotor, OUTPUT_A, OUTPUT_C, OUTPUT_D
from ev3dev2.sensor.lego import TouchSensor


class Port(Enum):
    LEFT = OUTPUT_C
    RIGHT = OUTPUT_D
    FORK = OUTPUT_A
    BUMPER = 'in4'


steer = MoveSteering(Port.LEFT.value, Port.RIGHT.value)
fork = MediumMotor(Port.FORK.value)
bumper = TouchSensor(Port.BUMPER.value)
steer.on_for_rotations(0, 30, 0.5)
print(bumper.is_pressed, fork.is_running)
