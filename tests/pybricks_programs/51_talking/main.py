#!/usr/bin/env pybricks-micropython
from pybricks.hubs import EV3Brick
from pybricks.parameters import Color, Button
from pybricks.tools import wait, StopWatch
from pybricks.media.ev3dev import SoundFile, ImageFile
from random import choice, randint

ev3 = EV3Brick()
sw = StopWatch()
ev3.speaker.set_volume(80)
ev3.speaker.set_volume(50, which='PCM')
ev3.speaker.set_speech_options('en', 'f3')
ev3.speaker.say("Hello, I am " + "EV3")
print("said", sw.time())
ev3.speaker.set_speech_options(language='nl', voice='m1', speed=150, pitch=60)
ev3.speaker.say(text="Ik ben een robot")

JINGLE = ['C4/4', 'E4/4', 'G4/4', 'C5/2', 'R/4', 'F#4/8', 'Bb3/8.', 'G4/8_', 'G4/4']
sw.reset()
ev3.speaker.play_notes(JINGLE)
print("notes took", sw.time())
sw.reset()
ev3.speaker.play_notes(iter(['C4/4', 'C4/4']), tempo=240)
print("fast", sw.time())

sounds = [SoundFile.CAT_PURR, SoundFile.DOG_BARK_1, SoundFile.T_REX_ROAR, SoundFile.HORN_1]
for i in range(2):
    ev3.speaker.play_file(choice(sounds))

for f in range(200, 1000, 200):
    ev3.speaker.beep(f, 50)
sw.reset()
ev3.speaker.beep(440.5, duration=250.0)
print("beep", sw.time())
ev3.speaker.beep(300, -1)
wait(200)
ev3.speaker.beep(0, 0)

numbers = [SoundFile.ONE, SoundFile.TWO, SoundFile.THREE]
for img, s in zip((ImageFile.UP, ImageFile.DOWN, ImageFile.EVIL), numbers):
    ev3.screen.load_image(img)
    ev3.speaker.play_file(s)
ev3.speaker.say("Number %d" % randint(1, 6))
ev3.speaker.play_file(SoundFile.GAME_OVER)
print("end")
