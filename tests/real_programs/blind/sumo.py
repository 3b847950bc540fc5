#!/usr/bin/env python3
"""
Sumo bot "El Toro"
 - IR sensor in front (port 4)
 - color sensor pointing down (port 3), ring is black with a white border
 - touch sensor behind the plough (port 1)
 - motors A and D, flipper (medium) on C
Rules: wait 3 seconds after pressing the button.
"""
import random
import time

from ev3dev2.button import Button
from ev3dev2.led import Leds
from ev3dev2.motor import LargeMotor, MediumMotor, MoveTank, OUTPUT_A, OUTPUT_C, OUTPUT_D
from ev3dev2.sensor import INPUT_1, INPUT_3, INPUT_4
from ev3dev2.sensor.lego import ColorSensor, InfraredSensor, TouchSensor
from ev3dev2.sound import Sound


class Toro:
    SEARCH, ATTACK, ESCAPE = range(3)

    def __init__(self):
        self.drive = MoveTank(OUTPUT_A, OUTPUT_D)
        self.flipper = MediumMotor(OUTPUT_C)
        self.ir = InfraredSensor(INPUT_4)
        self.floor = ColorSensor(INPUT_3)
        self.touch = TouchSensor(INPUT_1)
        self.leds = Leds()
        self.btn = Button()
        self.state = self.SEARCH
        self.direction = random.choice((-1, 1))

    def countdown(self):
        self.leds.set_color('LEFT', 'AMBER')
        self.leds.set_color('RIGHT', 'AMBER')
        self.btn.wait_for_bump('enter')
        s = Sound()
        for i in range(3):
            s.play_tone(440, 0.2)
            time.sleep(0.8)
        s.play_tone(880, 0.3, play_type=Sound.PLAY_NO_WAIT_FOR_COMPLETE)

    def on_border(self):
        return self.floor.reflected_light_intensity > 45

    def escape(self):
        self.drive.on_for_rotations(-80, -80, 1.2)
        self.drive.on_for_degrees(60 * self.direction, -60 * self.direction, 300)
        self.direction *= -1

    def flip(self):
        # flipper hits the frame on both sides so only use time
        self.flipper.on_for_seconds(100, 0.3)
        self.flipper.on_for_seconds(-60, 0.4, brake=False)

    def run(self):
        while not self.btn.backspace:
            if self.on_border():
                self.leds.set_color('LEFT', 'RED')
                self.escape()
                self.state = self.SEARCH
            elif self.touch.is_pressed:
                self.drive.on(100, 100)
                self.flip()
            elif self.ir.proximity < 55:
                self.leds.set_color('LEFT', 'GREEN')
                self.state = self.ATTACK
                self.drive.on(90, 90)
            else:
                self.state = self.SEARCH
                self.drive.on(35 * self.direction, -35 * self.direction)
            time.sleep(0.01)
        self.drive.off(brake=False)
        self.leds.reset()


if __name__ == "__main__":
    toro = Toro()
    toro.countdown()
    toro.run()
