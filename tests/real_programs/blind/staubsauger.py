#!/usr/bin/env python3
# Staubsauger-Roboter, Klasse 8b, Gruppe 3
#
# Achtung: Die Motoren sind verkehrt herum eingebaut,
# deshalb fährt der Roboter mit NEGATIVER Geschwindigkeit vorwärts!
# Motor A = links, Motor B = rechts, Motor C (mittel) = Bürste
# Taster: Port 1 = links vorne, Port 2 = rechts vorne

import random
from time import sleep
from ev3dev2.motor import *
from ev3dev2.sensor import *
from ev3dev2.sensor.lego import *
from ev3dev2.sound import Sound

fahren = MoveTank(OUTPUT_A, OUTPUT_B)
buerste = MediumMotor(OUTPUT_C)
taster_links = TouchSensor(INPUT_1)
taster_rechts = TouchSensor(INPUT_2)
ton = Sound()

TEMPO = 40


def vorwaerts():
    fahren.on(-TEMPO, -TEMPO)


def zurueck(umdrehungen):
    fahren.on_for_rotations(TEMPO, TEMPO, umdrehungen)


def drehen_links(grad):
    # linkes Rad rückwärts, rechtes vorwärts
    fahren.on_for_degrees(25, -25, grad * 2)


def drehen_rechts(grad):
    fahren.on_for_degrees(-25, 25, grad * 2)


buerste.on(75)
vorwaerts()
zaehler = 0

try:
    while True:
        links = taster_links.is_pressed
        rechts = taster_rechts.is_pressed

        if links or rechts:
            zaehler = zaehler + 1
            print("Hindernis Nr.", zaehler)
            fahren.off()
            ton.beep()
            zurueck(0.7)
            if links and rechts:
                drehen_rechts(random.randint(120, 200))
            elif links:
                drehen_rechts(random.randint(30, 90))
            else:
                drehen_links(random.randint(30, 90))
            vorwaerts()

        sleep(0.02)
except KeyboardInterrupt:
    fahren.off()
    buerste.off()
    print("Tschüss!")
