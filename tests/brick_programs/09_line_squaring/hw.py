from ev3dev2.motor import MoveTank, OUTPUT_B, OUTPUT_C
from ev3dev2.sensor import INPUT_2, INPUT_3
from ev3dev2.sensor.lego import ColorSensor
from ev3dev2.sound import Sound

tank = MoveTank(OUTPUT_B, OUTPUT_C)
left = ColorSensor(INPUT_2)
right = ColorSensor(INPUT_3)
_sound = Sound()


def beep():
    _sound.play_tone(660, 0.15, play_type=Sound.PLAY_NO_WAIT_FOR_COMPLETE)
