#!/usr/bin/env python3.7
import asyncio

from ev3dev2.motor import LargeMotor, MoveTank, OUTPUT_B, OUTPUT_C, SpeedPercent
from ev3dev2.sensor.lego import ColorSensor, UltrasonicSensor
from ev3dev2.sensor import INPUT_2
from ev3dev2.sound import Sound

tank = MoveTank(OUTPUT_B, OUTPUT_C)
us = UltrasonicSensor()
cs = ColorSensor(INPUT_2)


async def until_idle(timeout=10):
    async def poll():
        while tank.left_motor.is_running or tank.right_motor.is_running:
            await asyncio.sleep(0.02)
    await asyncio.sleep(0.05)
    await asyncio.wait_for(poll(), timeout)


async def patrol():
    for rot in (1, -1, 0.5, -0.5):
        tank.on_for_rotations(SpeedPercent(35), SpeedPercent(35), rot, block=False)
        await until_idle()
        print(f'leg {rot:+} done')


async def watch(history):
    try:
        while True:
            history.append((us.distance_centimeters, cs.reflected_light_intensity))
            await asyncio.sleep(0.1)
    except asyncio.CancelledError:
        print('watcher cancelled')
        raise


async def too_long():
    try:
        await asyncio.wait_for(asyncio.sleep(30), timeout=0.5)
    except asyncio.TimeoutError:
        print('timeout works')


async def main():
    history = []
    w = asyncio.ensure_future(watch(history))
    await asyncio.gather(patrol(), too_long())
    w.cancel()
    try:
        await w
    except asyncio.CancelledError:
        pass
    # blocking library call in the default executor
    loop = asyncio.get_running_loop()
    await loop.run_in_executor(None, lambda: Sound().tone(523, 200))
    dist = [d for d, _ in history]
    print('samples > 20:', len(history) > 20, ' moved:', max(dist) - min(dist) > 10)


try:
    asyncio.run(main())
finally:
    tank.off()
