from ev3dev2.motor import MediumMotor
from robot import config

fork = MediumMotor(config.FORK)
