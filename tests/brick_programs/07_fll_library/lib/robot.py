from math import pi
from time import sleep

from ev3dev2.motor import LargeMotor, MediumMotor, MoveTank, SpeedPercent
from ev3dev2.power import PowerSupply
from ev3dev2.sensor.lego import GyroSensor
from ev3dev2.sound import Sound
from ev3dev2.stopwatch import StopWatch

from .util import clamp


class Robot:
    def __init__(self, cfg):
        self.cfg = cfg
        self.tank = MoveTank(cfg['left'], cfg['right'])
        self.arm = MediumMotor(cfg['attachment'])
        self.lift = MediumMotor(cfg['lift'])
        self.gyro = GyroSensor(cfg['gyro'])
        self.sound = Sound()
        self.watch = StopWatch()
        self.mm_per_degree = pi * cfg['wheel_mm'] / 360

    def check_battery(self):
        volts = PowerSupply().measured_volts
        if volts < 7.2:
            self.sound.beep()
            print('battery low: {:.2f} V'.format(volts))

    def reset_for_mission(self):
        self.watch.restart()
        self.gyro.reset()
        sleep(0.1)
        self.tank.reset()

    def straight(self, mm, speed=None):
        """Gyro straight: proportional correction, both wheels averaged."""
        speed = speed or self.cfg['cruise']
        heading = self.gyro.angle
        goal = abs(mm) / self.mm_per_degree
        l0, r0 = self.tank.left_motor.position, self.tank.right_motor.position
        sign = 1 if mm > 0 else -1
        while True:
            done = (abs(self.tank.left_motor.position - l0) + abs(self.tank.right_motor.position - r0)) / 2
            if done >= goal:
                break
            fix = clamp(self.cfg['gyro_gain'] * (heading - self.gyro.angle), -15, 15)
            v = speed if goal - done > 90 else 15
            self.tank.on(SpeedPercent(sign * v + fix), SpeedPercent(sign * v - fix))
            sleep(0.01)
        self.tank.off(brake=True)
        return done * self.mm_per_degree

    def turn(self, degrees, fast=25, slow=6):
        """Turn to the right by degrees, slow near the end."""
        goal = self.gyro.angle + degrees
        while True:
            err = goal - self.gyro.angle
            if abs(err) <= 1:
                break
            v = fast if abs(err) > 25 else slow
            v = v if err > 0 else -v
            self.tank.on(v, -v)
            sleep(0.005)
        self.tank.off()

    def arm_to(self, degrees, speed=30):
        self.arm.on_for_degrees(SpeedPercent(speed), degrees)

    def lift_turns(self, turns, speed=50, wait=True):
        self.lift.on_for_rotations(SpeedPercent(speed), turns, block=wait)
