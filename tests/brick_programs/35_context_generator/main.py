#!/usr/bin/env python3
"""Pythonic robot: context manager for the motors, generators for behaviour."""
import contextlib
import itertools
import time

from ev3dev2.motor import LargeMotor, OUTPUT_B, OUTPUT_C, SpeedDPS
from ev3dev2.sensor import INPUT_2, INPUT_3, INPUT_4
from ev3dev2.sensor.lego import ColorSensor, GyroSensor


@contextlib.contextmanager
def motors(*ports):
    ms = [LargeMotor(p) for p in ports]
    for m in ms:
        m.reset()
    try:
        yield ms
    finally:
        for m in ms:
            m.off(brake=False)
        print('motors released')


@contextlib.contextmanager
def timed(label):
    t = time.perf_counter()
    yield
    print('{}: about {:.0f} s'.format(label, time.perf_counter() - t))


def ramp(top, step=40):
    yield from range(0, top, step)
    yield top


def ticks(period):
    nxt = time.time()
    for n in itertools.count():
        yield n
        nxt += period
        time.sleep(max(0, nxt - time.time()))


def drive(left, right):
    """Coroutine: send (l, r) in deg/s."""
    while True:
        l, r = yield
        left.on(SpeedDPS(l))
        right.on(SpeedDPS(r))


def main():
    gyro = GyroSensor(INPUT_4)
    with motors(OUTPUT_B, OUTPUT_C) as (left, right):
        d = drive(left, right)
        next(d)
        with timed('ramp'):
            for _, v in zip(ticks(0.1), ramp(400)):
                d.send((v, v))
            d.send((400, 400))
            time.sleep(1)
        with timed('turn'):
            start = gyro.angle
            for n in ticks(0.05):
                rest = 120 - (gyro.angle - start)
                if rest <= 0 or n > 200:
                    break
                v = max(60, min(250, 3 * rest))
                d.send((v, -v))
        d.close()
        raise_it = left.position > 100 and abs(gyro.angle - 120) < 15
        eyes = {p: ColorSensor(p) for p in (INPUT_2, INPUT_3)}
        print({p[-3:]: e.color_name for p, e in eyes.items()})
        with contextlib.suppress(ZeroDivisionError):
            1 / (0 if raise_it else 1)
            print('turned badly')
    print('end')


if __name__ == '__main__':
    main()
