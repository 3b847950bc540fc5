#!/usr/bin/env python3
"""MoveTank subclass with everything our robot can do, used in the summer course."""

from time import sleep

from ev3dev2.motor import (LineFollowErrorLostLine, LineFollowErrorTooFast, MoveTank,
                           OUTPUT_A, OUTPUT_C, SpeedPercent, follow_for_ms)
from ev3dev2.sensor import INPUT_2, INPUT_4
from ev3dev2.sensor.lego import ColorSensor, UltrasonicSensor
from ev3dev2.stopwatch import StopWatch


class Rob(MoveTank):

    def __init__(self, left=OUTPUT_A, right=OUTPUT_C, light=INPUT_2, us=INPUT_4):
        super().__init__(left, right, desc='Rob')
        self.cs = ColorSensor(light)
        self.us = UltrasonicSensor(us)
        self.watch = StopWatch()
        self.watch.start()

    def say(self, *args):
        print('[{:7.2f}]'.format(self.watch.value_secs), *args)

    def on_for_cm(self, speed, cm):
        self.on_for_rotations(speed, speed, cm / 17.6)

    def spin(self, degrees, speed=20):
        wheel = degrees * 2.15      # tested on the big table
        self.on_for_degrees(SpeedPercent(speed), SpeedPercent(-speed), wheel)

    def measure_target(self):
        """sweep over the line, target = middle of black and white"""
        lo, hi = 100, 0
        self.on(10, -10)
        self.watch_until = self.watch.value_ms + 1200
        while self.watch.value_ms < self.watch_until:
            v = self.cs.reflected_light_intensity
            lo, hi = min(lo, v), max(hi, v)
        self.on_for_seconds(-10, 10, 1.2)
        self.say('black', lo, 'white', hi)
        return (lo + hi) // 2, hi

    def obstacle(self, cm=12):
        return self.us.distance_centimeters < cm


def no_obstacle(tank, cm=12, ms=8000):
    return follow_for_ms(tank, ms) and not tank.obstacle(cm)


rob = Rob()
target, white = rob.measure_target()

try:
    rob.follow_line(kp=4.2, ki=0.01, kd=2.0, speed=SpeedPercent(20),
                    target_light_intensity=target, white=max(white - 3, target + 5),
                    off_line_count_max=60, follow_for=follow_for_ms, ms=5000)
    rob.say('part one done')
    rob.follow_line(kp=4.2, ki=0.01, kd=2.0, speed=SpeedPercent(15),
                    target_light_intensity=target, white=101,
                    follow_for=no_obstacle, cm=10)
    rob.say('stopped', rob.us.distance_centimeters)
except LineFollowErrorLostLine:
    rob.say('lost the line :-(')
except LineFollowErrorTooFast:
    rob.stop()
    raise

rob.on_for_cm(-25, 10)
rob.spin(180)
rob.on_for_cm(40, 30)
sleep(0.5)
rob.off(brake=False)
rob.say('bye')
