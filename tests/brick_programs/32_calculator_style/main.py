# my robot programm 3.0 FINAL
# (my teacher says i should use functions but it works)
import ev3dev2.motor
import ev3dev2.sensor.lego
import ev3dev2.sound
import ev3dev2.button
import time, datetime, string, re, socket
knopf = ev3dev2.button.Button
m1 = ev3dev2.motor.LargeMotor("outB")
m2 = ev3dev2.motor.LargeMotor("outC")
sens = ev3dev2.sensor.lego.ColorSensor("in2")
i = 0
Ende = "nein"
while Ende != "ja":
    i = i + 1
    if i == 1:
        m1.run_forever(speed_sp = 300)
        m2.run_forever(speed_sp = 300)
    if i == 1 or i == 2 or i == 3:
        time.sleep(0.5)
        hell = sens.reflected_light_intensity
        if hell > 50: wort = "hell"
        elif hell <= 50: wort = "dunkel"
        print("Messung Nr. " + str(i) + " = " + wort)
    if i == 4:
        m1.stop(stop_action = "brake")
        m2.stop(stop_action = "brake")
        time.sleep(0.5)
        weg = (m1.position + m2.position) / 2 / 360 * 17.6
        print("Weg ungefaehr", int(round(weg, -1)), "cm")
    if i == 5:
        m1.run_to_rel_pos(position_sp = -270, speed_sp = 300)
        m2.run_to_rel_pos(position_sp = -270, speed_sp = 300)
        m1.wait_while('running')
        m2.wait_while('running')
    if i > 5:
        Ende = "ja"
        print("Richtung rueckwaerts: %s" % (m1.position < 400))
        assert 1 == 1, "geht nicht"
        for ton in [262, 294, 330, 349, 392]: ev3dev2.sound.Sound().tone([(ton, 150, 20)])
