#!/usr/bin/env pybricks-micropython
from pybricks.hubs import EV3Brick
from pybricks.media.ev3dev import SoundFile
from pybricks.tools import wait

ev3 = EV3Brick()
ev3.speaker.set_volume(100)
ev3.speaker.set_volume(40, which='Beep')
ev3.speaker.play_file(SoundFile.HELLO)
ev3.speaker.play_file(file=SoundFile.FANFARE)
ev3.speaker.play_file(file_name=SoundFile.MOTOR_START)
ev3.speaker.set_speech_options(language='de', voice='m1', speed=120, pitch=70)
ev3.speaker.say("Guten Tag")
ev3.speaker.set_speech_options('en', 'f1')
ev3.speaker.say("Mission complete")
try:
    ev3.speaker.play_file("horn.wav")
except RuntimeError as e:
    print("no such sound", "failed" in str(e))
try:
    ev3.speaker.say(42)
except TypeError:
    print("only text", True)
ev3.speaker.beep(880, -1)
wait(300)
ev3.speaker.beep(440, 50)
print("done")
