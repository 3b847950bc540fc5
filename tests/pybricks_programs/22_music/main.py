#!/usr/bin/env pybricks-micropython
from pybricks.hubs import EV3Brick
from pybricks.tools import StopWatch

ev3 = EV3Brick()
jacques = ['C4/4', 'D4/4', 'E4/4', 'C4/4', 'C4/4', 'D4/4', 'E4/4', 'C4/4',
           'E4/4', 'F4/4', 'G4/2', 'E4/4', 'F4/4', 'G4/2',
           'G4/4', 'R/4', 'A4/4', 'Bb4/4']
watch = StopWatch()
ev3.speaker.play_notes(jacques, tempo=200)
print("6000 ms", abs(watch.time() - 6000) < 20)
watch.reset()
ev3.speaker.play_notes(['C4/4.', 'R/8', 'E4/2_'])
print("2000 ms", abs(watch.time() - 2000) < 20)
bad = 0
for notes in (['C9/4'], ['Fb4/4']):
    try:
        ev3.speaker.play_notes(notes)
    except ValueError:
        bad += 1
print(bad, "refused")
