#!/usr/bin/env python3
"""Puppy (core set model). No wheels: the two large motors are the legs.

A right legs, D left legs, C head (medium), touch sensor on the back (1), color sensor
in the mouth (4). Put the puppy in the lying position before you start the program.
"""
import random
import time

from ev3dev2.display import Display
from ev3dev2.motor import LargeMotor, MediumMotor, MotorSet, OUTPUT_A, OUTPUT_C, OUTPUT_D
from ev3dev2.sensor import INPUT_1, INPUT_4
from ev3dev2.sensor.lego import ColorSensor, TouchSensor
from ev3dev2.sound import Sound

HALF_UP = 25
STAND_UP = 65
STRETCH = 125
HEAD_GEAR = 24


class Puppy:
    def __init__(self):
        self.legs = MotorSet({OUTPUT_A: LargeMotor, OUTPUT_D: LargeMotor})
        self.head = MediumMotor(OUTPUT_C)
        self.touch = TouchSensor(INPUT_1)
        self.mouth = ColorSensor(INPUT_4)
        self.sound = Sound()
        self.lcd = Display()
        self.hunger = 0
        self.love = 5
        self.head.position = 0

    def move_legs(self, pos, speed=150):
        self.legs.run_to_abs_pos(position_sp=pos, speed_sp=speed, stop_action='hold')
        self.legs.wait_while('running', timeout=3000)

    def eyes(self, look='open'):
        self.lcd.clear()
        for x in (50, 128):
            if look == 'open':
                self.lcd.circle(False, x, 64, 28, 'white', 'black')
                self.lcd.circle(False, x, 64, 10)
            else:
                self.lcd.line(False, x - 28, 64, x + 28, 64, width=4)
        self.lcd.update()

    def nod(self, n=2):
        for _ in range(n):
            self.head.on_for_degrees(40, 10 * HEAD_GEAR)
            self.head.on_for_degrees(-40, 10 * HEAD_GEAR)

    def sit(self):
        self.move_legs(HALF_UP, 50)

    def stand(self):
        self.move_legs(HALF_UP, 100)
        self.move_legs(STAND_UP, 50)

    def stretch(self):
        self.stand()
        self.move_legs(STRETCH, 100)
        self.sound.speak('aaah', play_type=Sound.PLAY_NO_WAIT_FOR_COMPLETE)
        self.move_legs(STAND_UP, 100)

    def hop(self):
        for _ in range(3):
            self.legs.run_forever(speed_sp=500)
            time.sleep(0.2)
            self.legs.stop()
            time.sleep(0.1)
            self.legs.run_forever(speed_sp=-200)
            time.sleep(0.4)
            self.legs.off(brake=True)
        self.move_legs(STAND_UP)

    def sleep(self):
        self.eyes('closed')
        self.move_legs(0, 50)
        self.legs.off(brake=False)

    def live(self):
        last = time.time()
        self.stretch()
        self.eyes()
        while True:
            if self.touch.is_pressed:
                self.love += 1
                self.nod()
            if self.mouth.color in (ColorSensor.COLOR_RED, ColorSensor.COLOR_GREEN):
                self.hunger = max(0, self.hunger - 3)
                self.sound.tone([(300, 80, 40)] * 3)
            if time.time() - last > 6:
                last = time.time()
                self.hunger += 1
                self.love -= 1
                if self.hunger > 5:
                    self.sit()
                    self.nod(1)
                elif self.love > 4:
                    self.stand()
                    self.hop()
                elif self.love < 0:
                    self.sleep()
                else:
                    random.choice((self.sit, self.stand, self.stretch))()
                    self.eyes()
            time.sleep(0.05)


if __name__ == '__main__':
    dog = Puppy()
    try:
        dog.live()
    except KeyboardInterrupt:
        dog.sleep()
