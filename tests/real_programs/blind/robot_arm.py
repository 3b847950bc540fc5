#!/usr/bin/env python3
"""
Robot Arm H25 (EV3 Education core set), moves a ring of cups between three stations.

    port A  gripper (medium)           closes on end stop
    port B  elbow (large, 8:40 gear)   color sensor on port 3 sees the white beam when it's up
    port C  turntable (large, 12:36)   touch sensor on port 1 at the left limit
"""
import time
from ev3dev2.motor import OUTPUT_A, OUTPUT_B, OUTPUT_C, LargeMotor, MediumMotor
from ev3dev2.sensor import INPUT_1, INPUT_3
from ev3dev2.sensor.lego import ColorSensor, TouchSensor
from ev3dev2.sound import Sound

ELBOW_GEAR = 40 / 8
BASE_GEAR = 36 / 12


class Joint:
    def __init__(self, motor, gear=1.0, speed=60):
        self.motor = motor
        self.gear = gear
        self.speed = speed * gear     # motor deg/s for joint deg/s
        motor.reset()
        motor.stop_action = motor.STOP_ACTION_HOLD
        motor.ramp_up_sp = 200
        motor.ramp_down_sp = 200

    def zero(self, angle=0):
        self.motor.position = int(angle * self.gear)

    def goto(self, angle, wait=True):
        self.motor.run_to_abs_pos(position_sp=int(angle * self.gear), speed_sp=int(self.speed))
        if wait:
            self.motor.wait_while('running', timeout=8000)


class Arm:
    def __init__(self):
        self.gripper = MediumMotor(OUTPUT_A)
        self.elbow = Joint(LargeMotor(OUTPUT_B), ELBOW_GEAR, 30)
        self.base = Joint(LargeMotor(OUTPUT_C), BASE_GEAR, 60)
        self.base_limit = TouchSensor(INPUT_1)
        self.elbow_eye = ColorSensor(INPUT_3)

    def calibrate(self):
        m = self.elbow.motor
        m.run_timed(time_sp=1000, speed_sp=-150)     # away from the sensor first
        m.wait_while('running')
        m.run_forever(speed_sp=75)
        while self.elbow_eye.reflected_light_intensity < 32:
            time.sleep(0.01)
        m.stop()
        self.elbow.zero(60)

        m = self.base.motor
        m.run_forever(speed_sp=-180)
        while not self.base_limit.is_pressed:
            time.sleep(0.01)
        m.stop()
        self.base.zero(0)

        self.gripper.run_forever(speed_sp=200, stop_action='coast')
        while 'stalled' not in self.gripper.state:
            time.sleep(0.02)
        self.gripper.stop()
        self.gripper.position = 0
        self.open()

    def open(self):
        self.gripper.run_to_abs_pos(position_sp=-90, speed_sp=200, stop_action='hold')
        self.gripper.wait_while('running', timeout=2000)

    def close(self):
        self.gripper.run_forever(speed_sp=200, stop_action='hold')
        self.gripper.wait_until('stalled', 1500)
        self.gripper.stop()

    def pick(self, where):
        self.base.goto(where)
        self.elbow.goto(-40)
        self.close()
        self.elbow.goto(60)

    def place(self, where):
        self.base.goto(where)
        self.elbow.goto(-40)
        self.open()
        self.elbow.goto(60)


LEFT, MIDDLE, RIGHT = 20, 100, 180

if __name__ == '__main__':
    arm = Arm()
    arm.calibrate()
    Sound().beep()
    for (a, b) in ((LEFT, MIDDLE), (MIDDLE, RIGHT), (RIGHT, LEFT)):
        arm.pick(a)
        arm.place(b)
    arm.base.goto(MIDDLE)
