from pybricks.hubs import EV3Brick
from pybricks.ev3devices import Motor, GyroSensor
from pybricks.parameters import Stop
from pybricks.robotics import DriveBase
from pybricks.tools import wait


class Robot:
    def __init__(self, left, right, gyro, wheel, track):
        self.ev3 = EV3Brick()
        self.left = Motor(left)
        self.right = Motor(right)
        self.gyro = GyroSensor(gyro)
        self.base = DriveBase(self.left, self.right, wheel, track)

    def log(self, *args):
        print("[robot]", *args)

    def straight(self, distance, speed=120):
        self.base.reset()
        self.gyro.reset_angle(0)
        if distance < 0:
            speed = -speed
        while abs(self.base.distance()) < abs(distance):
            self.base.drive(speed, -2 * self.gyro.angle())
            wait(5)
        self.halt()
        self.log("straight", distance, "done")

    def turn(self, angle):
        self.gyro.reset_angle(0)
        error = angle
        while abs(error) > 1:
            rate = max(20, min(120, abs(error) * 2))
            self.base.drive(0, rate if error > 0 else -rate)
            wait(5)
            error = angle - self.gyro.angle()
        self.halt()
        self.log("turn", angle, "done", abs(self.gyro.angle() - angle) <= 3)

    def halt(self):
        self.base.stop()
        self.left.hold()
        self.right.hold()
        wait(100)

    def end(self):
        self.left.stop()
        self.right.stop()
        self.ev3.speaker.beep()
