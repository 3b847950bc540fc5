from time import sleep, time

from hw import tank, left, right

BLACK = 20
TARGET = 45


def drive_until_black(speed, timeout):
    end = time() + timeout
    tank.on(speed, speed)
    try:
        while time() < end:
            if left.reflected_light_intensity < BLACK or right.reflected_light_intensity < BLACK:
                return True
            sleep(0.005)
        return False
    finally:
        tank.off()


def square_up(gain=0.4, seconds=2.0):
    end = time() + seconds
    el = er = 0
    while time() < end:
        el = left.reflected_light_intensity - TARGET
        er = right.reflected_light_intensity - TARGET
        if abs(el) < 3 and abs(er) < 3:
            break
        tank.on(max(-20, min(20, gain * el)), max(-20, min(20, gain * er)))
        sleep(0.01)
    tank.off()
    return el, er
