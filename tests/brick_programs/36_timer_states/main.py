#!/usr/bin/env python3
# traffic light + delivery robot, state machine with threading.Timer
import threading
from enum import Enum, auto
from time import sleep
from ev3dev2.led import Leds
from ev3dev2.motor import MoveTank, OUTPUT_B, OUTPUT_C, SpeedRPS
from ev3dev2.sound import Sound
from ev3dev2.stopwatch import StopWatch, StopWatchAlreadyStartedException


class Light(Enum):
    RED = auto()
    YELLOW = auto()
    GREEN = auto()


class TrafficLight:
    ORDER = {Light.RED: (Light.GREEN, 1.5), Light.GREEN: (Light.YELLOW, 2.0), Light.YELLOW: (Light.RED, 0.5)}

    def __init__(self, listener):
        self.leds = Leds()
        self.listener = listener
        self.timer = None
        self.state = None
        self.running = True
        self.lock = threading.RLock()

    def enter(self, state):
        with self.lock:
            if not self.running:
                return
            self.state = state
            for side in ('LEFT', 'RIGHT'):
                self.leds.set_color(side, state.name)
            nxt, after = self.ORDER[state]
            self.timer = threading.Timer(after, self.enter, args=(nxt,))
            self.timer.start()
        self.listener(state)

    def stop(self):
        with self.lock:
            self.running = False
            self.timer.cancel()


tank = MoveTank(OUTPUT_B, OUTPUT_C)
sw = StopWatch()
sw.start()
try:
    sw.start()
except StopWatchAlreadyStartedException:
    print('watch runs already')


def obey(state):
    print('{:>4.1f} {}'.format(round(sw.value_ms / 500) / 2, state.name))
    if state is Light.GREEN:
        tank.on(SpeedRPS(0.8), SpeedRPS(0.8))
    elif state is Light.YELLOW:
        tank.on(SpeedRPS(0.3), SpeedRPS(0.3))
    else:
        tank.off()


tl = TrafficLight(obey)
tl.enter(Light.RED)
sleep(9.75)
tl.stop()
tank.off()
print('stopped in', tl.state.name, 'timers alive:', tl.timer.is_alive() and not tl.timer.finished.is_set())
Sound().play_tone(300, 0.3)
