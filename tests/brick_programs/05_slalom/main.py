#!/usr/bin/env python3
from ev3dev2.motor import MoveSteering, OUTPUT_B, OUTPUT_C
from ev3dev2.sound import Sound
from time import sleep
import sys

# globale Variablen
lenkung = 30
tempo = 30
runden = 3
strecke = 0

fahrwerk = MoveSteering(OUTPUT_B, OUTPUT_C)

def links():
    global strecke
    fahrwerk.on_for_seconds(-lenkung, tempo, 0.75)
    strecke = strecke + 0.75

def rechts():
    global strecke
    fahrwerk.on_for_seconds(lenkung, tempo, 0.75)
    strecke = strecke + 0.75

def slalom(wie_oft):
    for x in range(0, wie_oft):
        print("Kurve", x, file=sys.stderr)
        rechts()
        links()
        links()
        rechts()
        global tempo
        tempo = tempo + 5

if __name__ == "__main__":
    slalom(runden)
    print("Fahrzeit: %.2f Sekunden" % strecke)
    print("Tempo am Ende: %d" % tempo)
    Sound().beep()
