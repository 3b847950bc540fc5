#!/usr/bin/env python3
"""Sensor thread -> queue -> driver; a third thread blinks. Everything ends by an Event."""
import queue
import threading
import time

from ev3dev2.led import Leds
from ev3dev2.motor import MoveTank, OUTPUT_B, OUTPUT_C
from ev3dev2.sensor.lego import GyroSensor, UltrasonicSensor

stop = threading.Event()
readings = queue.Queue(maxsize=50)
print_lock = threading.Lock()


def say(*args):
    with print_lock:
        print(*args)


def sense():
    us, gyro = UltrasonicSensor(), GyroSensor()
    while not stop.is_set():
        try:
            readings.put((time.monotonic(), us.distance_centimeters, gyro.angle), timeout=0.2)
        except queue.Full:
            say('queue full')
        time.sleep(0.05)
    readings.put(None)


def blink():
    leds = Leds()
    on = False
    while not stop.wait(0.25):
        on = not on
        leds.set_color('LEFT', 'RED' if on else 'BLACK')
        leds.set_color('RIGHT', 'BLACK' if on else 'RED')
    leds.reset()


class Driver(threading.Thread):
    def __init__(self):
        super().__init__(name='driver')
        self.tank = MoveTank(OUTPUT_B, OUTPUT_C)
        self.count = 0
        self.worst = 0

    def run(self):
        try:
            while True:
                item = readings.get()
                if item is None:
                    break
                _, cm, angle = item
                self.count += 1
                self.worst = max(self.worst, abs(angle))
                speed = 35 if cm > 50 else 0
                self.tank.on(speed - angle, speed + angle)
        finally:
            self.tank.off()


def main():
    workers = [threading.Thread(target=sense, name='sense'),
               threading.Thread(target=blink, name='blink', daemon=True)]
    driver = Driver()
    driver.start()
    for w in workers:
        w.start()
    time.sleep(5)
    stop.set()
    for w in workers + [driver]:
        w.join(3)
        say(w.name, 'alive' if w.is_alive() else 'finished')
    say('messages plausible:', 40 < driver.count < 110)
    say('straight:', driver.worst <= 3)


if __name__ == '__main__':
    main()
