#!/usr/bin/env python3
# patrols around, flashes the lights, stops for obstacles
# thread 1: lights, thread 2: siren, main: driving
import threading
import time
from ev3dev2.led import Leds
from ev3dev2.motor import MoveSteering
from ev3dev2.sensor.lego import UltrasonicSensor
from ev3dev2.sound import Sound

LEFT = 'ev3-ports:outB'
RIGHT = 'ev3-ports:outC'
EYES = 'ev3-ports:in4'

alarm = threading.Event()
ende = threading.Event()


class Lights(threading.Thread):
    def __init__(self):
        threading.Thread.__init__(self)
        self.leds = Leds()

    def run(self):
        flip = False
        while not ende.is_set():
            if alarm.is_set():
                self.leds.set_color('LEFT', 'RED' if flip else 'BLACK')
                self.leds.set_color('RIGHT', 'BLACK' if flip else 'AMBER')
                flip = not flip
                time.sleep(0.15)
            else:
                self.leds.set_color('LEFT', 'GREEN')
                self.leds.set_color('RIGHT', 'GREEN')
                time.sleep(0.3)
        self.leds.reset()


def siren():
    s = Sound()
    s.set_volume(30)
    while not ende.is_set():
        if alarm.wait(0.5):
            s.tone([(660, 200, 20), (440, 200, 20)])


def patrol():
    drive = MoveSteering(LEFT, RIGHT)
    eyes = UltrasonicSensor(EYES)
    side = 1
    try:
        while True:
            if eyes.distance_centimeters < 30:
                drive.off()
                alarm.set()
                time.sleep(1)
                drive.on_for_rotations(0, -30, 0.8)
                drive.on_for_degrees(100 * side, 25, 230)
                side = -side
                alarm.clear()
            else:
                drive.on(5 * side, 40)
            time.sleep(0.05)
    except KeyboardInterrupt:
        print('Ctrl-C, stopping')
    finally:
        drive.off(brake=False)


if __name__ == '__main__':
    threads = [Lights(), threading.Thread(target=siren)]
    for t in threads:
        t.daemon = True
        t.start()
    patrol()
    ende.set()
    for t in threads:
        t.join(2)
