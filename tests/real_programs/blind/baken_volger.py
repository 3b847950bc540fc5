#!/usr/bin/env python3
# Robot die de infrarood-afstandsbediening (baken, kanaal 2) achterna rijdt.
# Zet het baken aan met de bovenste knop.

from time import sleep
from ev3dev2.auto import *

KANAAL = 2
MAX = 60

motoren = MoveTank(OUTPUT_C, OUTPUT_B)   # links zit op C, rechts op B
staart = MediumMotor(OUTPUT_A)
ir = InfraredSensor(INPUT_4)
lampjes = Leds()
geluid = Sound()


def begrens(x):
    return max(-MAX, min(MAX, x))


def kwispel():
    for i in range(2):
        staart.on_for_degrees(80, 40)
        staart.on_for_degrees(80, -40)


zoek_richting = 1
kwijt = 0

while True:
    richting, afstand = ir.heading_and_distance(KANAAL)

    if afstand is None:
        # baken kwijt
        kwijt += 1
        lampjes.set_color('LEFT', 'RED')
        lampjes.set_color('RIGHT', 'RED')
        if kwijt > 10:
            motoren.on(12 * zoek_richting, -12 * zoek_richting)
        else:
            motoren.off()
        if kwijt % 200 == 0:
            zoek_richting = -zoek_richting
    elif afstand < 5 and abs(richting) < 8:
        # er bijna!
        kwijt = 0
        motoren.off()
        geluid.beep()
        kwispel()
    else:
        kwijt = 0
        lampjes.set_color('LEFT', 'GREEN')
        lampjes.set_color('RIGHT', 'GREEN')
        vooruit = begrens(afstand * 1.5)
        draai = richting * 2
        zoek_richting = 1 if richting >= 0 else -1
        motoren.on(begrens(vooruit + draai), begrens(vooruit - draai))

    sleep(0.03)
