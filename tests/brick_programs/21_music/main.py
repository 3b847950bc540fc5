#!/usr/bin/env python3
from ev3dev2.sound import Sound
from ev3dev2.motor import MediumMotor, LargeMotor, OUTPUT_B
import time

spkr = Sound()
spkr.set_volume(60)

# Star Wars main title, from the ev3dev docs
spkr.play_song((
    ('D4', 'e3'),
    ('D4', 'e3'),
    ('D4', 'e3'),
    ('G4', 'h'),
    ('D5', 'h'),
    ('C5', 'e3'),
    ('B4', 'e3'),
    ('A4', 'e3'),
    ('G5', 'h'),
    ('D5', 'q'),
), tempo=120)

FRERE = [('C4', 'q'), ('D4', 'q'), ('E4', 'q'), ('C4', 'q')] * 2
FRERE += [('E4', 'q'), ('F4', 'q'), ('G4', 'h')]
t = time.time()
spkr.play_song(FRERE, tempo=200, delay=0.02)
print('song took about {:.0f} s'.format(time.time() - t))

for n in ('C4', 'E4', 'G4'):
    spkr.play_note(n, 0.2, volume=50)
spkr.play_note('C5', 0.6, play_type=Sound.PLAY_NO_WAIT_FOR_COMPLETE)
spkr.tone(440, 250)
spkr.tone([(392, 350, 100), (392, 350, 100), (311.1, 250, 100)])
spkr.beep('-f 880 -l 100 -n -f 660 -l 100').__class__

wrong = 0
for bad in (('H4', 0.2), ('c4', 0.2), ('C4', 0)):
    try:
        spkr.play_note(*bad)
    except ValueError as e:
        wrong += 1
try:
    spkr.play_file('does_not_exist.wav')
except ValueError:
    wrong += 1
try:
    spkr.play_song([('X9', 'q')])
except (KeyError, ValueError):
    wrong += 1
print(wrong, 'of 5 refused')
spkr.speak('That is all folks')
