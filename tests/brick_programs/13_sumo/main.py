#!/usr/bin/env python3
# Mini sumo. Search by turning, charge when something is near, back off on the white edge (here: BLACK edge)
import enum
import time
from ev3dev2.motor import LargeMotor, MoveTank, OUTPUT_B, OUTPUT_C
from ev3dev2.sensor.lego import ColorSensor, UltrasonicSensor
from ev3dev2.sensor import INPUT_1, INPUT_2, INPUT_3
from ev3dev2.led import Leds


class State(enum.Enum):
    SEARCH = 'search'
    CHARGE = 'charge'
    RETREAT = 'retreat'
    OVER = 'over'


LEDCOLOR = {State.SEARCH: 'AMBER', State.CHARGE: 'RED', State.RETREAT: 'GREEN', State.OVER: 'BLACK'}


class Sumo:
    MATCH = 12.0
    SEE_CM = 40

    def __init__(self):
        self.t = MoveTank(OUTPUT_B, OUTPUT_C)
        self.us = UltrasonicSensor(INPUT_1)
        self.edges = [ColorSensor(INPUT_2), ColorSensor(INPUT_3)]
        self.leds = Leds()
        self.state = None
        self.since = 0
        self.history = []

    def go(self, new):
        if new is self.state:
            return
        self.state = new
        self.since = time.time()
        self.history.append(new.value)
        for g in ('LEFT', 'RIGHT'):
            self.leds.set_color(g, LEDCOLOR[new])

    def edge(self):
        return any(e.reflected_light_intensity < 15 for e in self.edges)

    def search(self):
        self.t.on(20, -20)
        if self.us.distance_centimeters < self.SEE_CM:
            self.go(State.CHARGE)

    def charge(self):
        self.t.on(60, 60)
        if self.edge() or time.time() - self.since > 1.0 or self.us.distance_centimeters < 8:
            self.go(State.RETREAT)

    def retreat(self):
        self.t.on(-40, -30)
        if time.time() - self.since > 1.2:
            self.go(State.SEARCH)

    def fight(self):
        end = time.time() + self.MATCH
        self.go(State.SEARCH)
        while time.time() < end:
            getattr(self, self.state.value)()
            time.sleep(0.02)
        self.t.off()
        self.go(State.OVER)


s = Sumo()
s.fight()
print(' -> '.join(s.history))
print('turned wheels:', s.t.left_motor.position != 0)
