from math import pi
from time import sleep

from ev3dev2.motor import LargeMotor, MediumMotor, MoveSteering, MoveTank
from ev3dev2.motor import OUTPUT_A, OUTPUT_B, OUTPUT_C, OUTPUT_D, SpeedPercent
from ev3dev2.sensor import INPUT_1, INPUT_3, INPUT_4
from ev3dev2.sensor.lego import ColorSensor, GyroSensor


class AbortRun(Exception):
    pass


class Robot:
    """Team 4711 Brick Busters, City Shaper"""
    WHEEL_CM = 8.16

    def __init__(self, btn=None, left=OUTPUT_B, right=OUTPUT_C, arm=OUTPUT_A, lift=OUTPUT_D):
        self.btn = btn
        self.tank = MoveTank(left, right)
        self.steer = MoveSteering(left, right)
        self.lm = LargeMotor(left)
        self.rm = LargeMotor(right)
        self.arm = MediumMotor(arm)
        self.lift = MediumMotor(lift)
        self.gyro = GyroSensor(INPUT_4)
        self.cl = ColorSensor(INPUT_1)
        self.cr = ColorSensor(INPUT_3)

    def check(self):
        # left button = "come back to base"
        if self.btn is not None and self.btn.left:
            self.stop_all()
            raise AbortRun()

    def stop_all(self):
        self.tank.off(brake=False)
        self.arm.off(brake=False)
        self.lift.off(brake=False)

    def reset(self):
        self.gyro.reset()
        self.arm.on_for_seconds(SpeedPercent(-40), 0.8, brake=False)   # against the frame
        self.arm.position = 0

    def gyro_straight(self, cm, speed=40, heading=0, kp=1.2):
        start = (self.lm.degrees + self.rm.degrees) / 2
        goal = abs(cm) / (pi * self.WHEEL_CM) * 360
        sign = 1 if cm > 0 else -1
        done = 0
        while done < goal:
            self.check()
            done = abs((self.lm.degrees + self.rm.degrees) / 2 - start)
            # slow down in the last 10 cm
            s = speed if goal - done > 140 else max(12, speed * (goal - done) / 140)
            corr = (self.gyro.angle - heading) * kp
            corr = max(-20, min(20, corr))
            self.tank.on(sign * s - corr, sign * s + corr)
        self.tank.off()

    def gyro_turn(self, heading, speed=18):
        while abs(self.gyro.angle - heading) > 1:
            self.check()
            err = heading - self.gyro.angle
            s = max(5, min(speed, abs(err) * 0.5))
            self.steer.on(100 if err > 0 else -100, s)
        self.steer.off()
        sleep(0.1)

    def until_line(self, speed=20, heading=0):
        while self.cl.reflected_light_intensity > 12:
            self.check()
            corr = (self.gyro.angle - heading) * 1.2
            self.tank.on(speed - corr, speed + corr)
        self.tank.off()
