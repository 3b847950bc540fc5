#!/usr/bin/env python3
# Suiveur de ligne à 3 capteurs de couleur (gauche, centre, droite)
# Coupe de robotique des lycées - équipe "Les Briques"
#
# S'arrête au 5e carrefour.

import time
from ev3dev2.motor import LargeMotor, OUTPUT_B, OUTPUT_C, SpeedPercent
from ev3dev2.sensor import INPUT_1, INPUT_2, INPUT_3
from ev3dev2.sensor.lego import ColorSensor

moteur_g = LargeMotor(OUTPUT_B)
moteur_d = LargeMotor(OUTPUT_C)
capteurs = [ColorSensor(p) for p in (INPUT_1, INPUT_2, INPUT_3)]

NOIR = [6, 7, 6]          # mesuré sur la piste
BLANC = [62, 71, 65]
POIDS = (-1.0, 0.0, 1.0)

VITESSE = 30
KP = 24
KD = 30
CARREFOURS = 5


def lire():
    """noirceur de chaque capteur, 0.0 = blanc ... 1.0 = noir"""
    res = []
    for c, n, b in zip(capteurs, NOIR, BLANC):
        v = (b - c.reflected_light_intensity) / (b - n)
        res.append(min(1.0, max(0.0, v)))
    return res


def borne(v):
    return min(100, max(-100, v))


def avancer(g, d):
    moteur_g.on(SpeedPercent(borne(g)))
    moteur_d.on(SpeedPercent(borne(d)))


def arreter():
    moteur_g.off()
    moteur_d.off()


def main():
    derniere = 0.0
    nb = 0
    sur_carrefour = False
    perdu_depuis = None

    while nb < CARREFOURS:
        n = lire()
        somme = sum(n)

        if somme > 2.4:
            if not sur_carrefour:
                nb += 1
                print('carrefour', nb)
            sur_carrefour = True
            avancer(VITESSE, VITESSE)
            continue
        sur_carrefour = False

        if somme < 0.15:
            # plus de ligne : on tourne du dernier côté connu
            if perdu_depuis is None:
                perdu_depuis = time.time()
            elif time.time() - perdu_depuis > 4:
                print('perdu !')
                break
            cote = 1 if derniere > 0 else -1
            avancer(18 * cote, -18 * cote)
            continue
        perdu_depuis = None

        position = sum(p * x for p, x in zip(POIDS, n)) / somme
        virage = KP * position + KD * (position - derniere)
        derniere = position
        avancer(VITESSE + virage, VITESSE - virage)

    arreter()


if __name__ == '__main__':
    try:
        main()
    finally:
        arreter()
