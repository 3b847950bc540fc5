#!/usr/bin/env python3
from time import sleep
from ev3dev2.led import Leds, LED_COLORS, LED_GROUPS
from ev3dev2.sound import Sound

leds = Leds()
spkr = Sound()

print(sorted(LED_GROUPS))
print(sorted(LED_COLORS))

for color in sorted(LED_COLORS):
    leds.set_color('LEFT', color)
    leds.set_color('RIGHT', color, pct=0.5)
    print('now', color)
    sleep(0.3)

leds.set_color('LEFT', (1, 0.2))     # own mixture red/green
sleep(0.5)

leds.animate_police_lights('RED', 'GREEN', sleeptime=0.25, duration=2)
leds.animate_flash('AMBER', sleeptime=0.25, duration=2)
leds.animate_cycle(('RED', 'GREEN', 'AMBER'), groups=('LEFT',), sleeptime=0.2, duration=2)
leds.animate_rainbow(duration=2)
print('blocking part over')

leds.animate_police_lights('YELLOW', 'ORANGE', sleeptime=0.5, duration=None, block=False)
for i in range(4):
    spkr.play_tone(600 + 200 * (i % 2), 0.5)
leds.animate_stop()
leds.set('LEFT', brightness_pct=0.1)
sleep(0.2)
try:
    leds.set_color('LEFT', 'PURPLE')
except AssertionError as e:
    print('no purple:', 'PURPLE' in str(e))
leds.all_off()
sleep(0.5)
leds.reset()
print('green again')
