#!/usr/bin/env python3
# PID line follower with two color sensors
# RoboKings - RCJ line 2020
# left sensor port 1, right sensor port 4, line (black tape) runs between them

from time import sleep, time

from ev3dev2.motor import OUTPUT_B, OUTPUT_C, MoveTank, SpeedPercent
from ev3dev2.sensor import INPUT_1, INPUT_4
from ev3dev2.sensor.lego import ColorSensor
from ev3dev2.button import Button
from ev3dev2.sound import Sound

LEFT_MOTOR = OUTPUT_B
RIGHT_MOTOR = OUTPUT_C
LEFT_EYE = INPUT_1
RIGHT_EYE = INPUT_4

BASE_SPEED = 28
KP = 0.55
KI = 0.0
KD = 1.9
BLACK = 14

tank = MoveTank(LEFT_MOTOR, RIGHT_MOTOR)
left_eye = ColorSensor(LEFT_EYE)
right_eye = ColorSensor(RIGHT_EYE)
btn = Button()
sound = Sound()


def clamp(x, lo=-100, hi=100):
    return max(lo, min(hi, x))


def follow():
    integral = 0
    last_error = 0
    crossings = 0
    last_crossing = 0

    while not btn.backspace:
        l = left_eye.reflected_light_intensity
        r = right_eye.reflected_light_intensity

        # both black = crossing, go straight over it
        if l < BLACK and r < BLACK:
            if time() - last_crossing > 0.7:
                crossings += 1
                last_crossing = time()
                print("crossing", crossings)
            tank.on(SpeedPercent(BASE_SPEED), SpeedPercent(BASE_SPEED))
            continue

        error = l - r
        integral = clamp(integral * 0.9 + error, -200, 200)
        derivative = error - last_error
        last_error = error
        turn = KP * error + KI * integral + KD * derivative

        tank.on(SpeedPercent(clamp(BASE_SPEED + turn)),
                SpeedPercent(clamp(BASE_SPEED - turn)))
        sleep(0.005)


sound.beep()
try:
    follow()
except KeyboardInterrupt:
    pass
finally:
    tank.off()
    print("stopped")
