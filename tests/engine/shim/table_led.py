"""Checks of the brick's lights: what each call makes of them, and how long it takes."""

from __future__ import annotations

from tests.engine.shim.checking import Check, Table

SETUP = """\
import time
from ev3dev2.led import *
from ev3dev2.led import platform
leds = Leds()
red, green = leds.leds['red_left'], leds.leds['green_left']

def now():
    return [leds.leds[name].brightness for name in ('red_left', 'green_left', 'red_right', 'green_right')]

def seconds(call, *words, **more):
    start = time.monotonic()
    call(*words, **more)
    return round(time.monotonic() - start, 2)

def seen(times, wait):
    found = []
    for _ in range(times):
        found.append(now())
        time.sleep(wait)
    return found
"""

OFF = [0, 0]
GREEN = [0, 255]
RED = [255, 0]
AMBER = [255, 255]

LED = Table(
    "ev3dev2.led",
    SETUP,
    (
        Check(
            "platform, LED_DEFAULT_COLOR, len(LEDS), LED_GROUPS['LEFT'], LED_COLORS['ORANGE']",
            "('ev3', 'GREEN', 4, ('red_left', 'green_left'), (1, 0.5))",
            "platform LEDS LED_GROUPS LED_COLORS LED_DEFAULT_COLOR",
        ),
        Check("now()", f"{GREEN + GREEN}", "Leds Leds.__init__ Leds.leds"),
        Check(
            "Led.SYSTEM_CLASS_NAME, Led.SYSTEM_DEVICE_NAME_CONVENTION",
            "('leds', '*')",
            "Led.SYSTEM_CLASS_NAME Led.SYSTEM_DEVICE_NAME_CONVENTION",
        ),
        Check(
            "str(leds), str(red), red.desc, str(Led('led1:green*')), Led('led1:green*').brightness",
            "('Leds', 'red_left', 'red_left', 'Led', 255)",
            "Led Led.__init__ Led.__str__ Led.desc Leds.__str__",
        ),
        Check("Led('led7*')", "DeviceNotFound: Led is not connected."),
        Check(
            "leds.led_colors is LED_COLORS, [str(led) for led in leds.led_groups['RIGHT']]",
            "(True, ['red_right', 'green_right'])",
            "Leds.led_colors Leds.led_groups",
        ),
        Check(
            "leds.set_color('LEFT', 'ORANGE'), now()",
            f"(None, {[255, 127, *GREEN]})",
            "Leds.set_color",
        ),
        Check("leds.set_color('RIGHT', (0.5, 0.3), pct=0.5), now()", "(None, [255, 127, 63, 38])"),
        Check("leds.set_color('LEFT', 'PINK')", "AssertionError: PINK is an invalid LED color"),
        Check("leds.set_color('UP', 'RED')", "AssertionError: UP is an invalid LED group"),
        Check(
            "leds.set('RIGHT', brightness_pct=0.2), now()", "(None, [255, 127, 51, 51])", "Leds.set"
        ),
        Check("leds.set('UP', brightness=1)", "AssertionError: UP is an invalid LED group"),
        Check("leds.all_off(), now()", f"(None, {OFF + OFF})", "Leds.all_off"),
        Check("leds.reset(), now()", f"(None, {GREEN + GREEN})", "Leds.reset"),
        Check("red.max_brightness", "255", "Led.max_brightness"),
        Check("red.brightness = 100"),
        Check("red.brightness, round(red.brightness_pct, 3)", "(100, 0.392)", "Led.brightness"),
        Check("red.brightness_pct = 0.2"),
        Check("red.brightness, red.brightness_pct", "(51, 0.2)", "Led.brightness_pct"),
        Check("red.brightness = 999"),
        Check("red.brightness", "255"),
        Check("red.brightness = -1", "ValueError"),
        Check("red.max_brightness = 1", "AttributeError"),
        # Triggers
        Check("red.triggers", "['none', 'timer', 'default-on']", "Led.triggers"),
        Check("red.trigger = 'sunshine'", "ValueError"),
        Check("red.delay_on", "DeviceNotFound: red_left is no longer connected"),
        Check("red.trigger", "ValueError: too many values to unpack"),
        Check("red.trigger = 'timer'", "None", "Led.trigger"),
        Check("(red.delay_on, red.delay_off)", "(500, 500)"),
        Check("red.delay_off = 200; red.delay_on = 300"),
        Check("(red.delay_on, red.delay_off)", "(300, 200)", "Led.delay_on Led.delay_off"),
        Check("[led[0] for led in seen(10, 0.096)]", "[255, 255, 255, 0, 0, 255, 255, 255, 0, 0]"),
        Check("red.delay_on = -1", "ValueError"),
        Check("red.brightness = 80; time.sleep(0.5)"),
        Check("set(led[0] for led in seen(10, 0.1))", "{80, 0}"),
        Check("red.delay_on = 0"),
        Check("set(led[0] for led in seen(10, 0.1))", "{0}"),
        Check("red.delay_on = 10; red.delay_off = 0"),
        Check("set(led[0] for led in seen(10, 0.1))", "{80}"),
        Check("red.trigger = 'timer'"),
        Check("red.brightness = 0"),
        Check("set(led[0] for led in seen(10, 0.1))", "{0}"),
        Check("red.delay_off", "DeviceNotFound: red_left is no longer connected"),
        Check("red.trigger = 'default-on'"),
        Check("red.brightness", "255"),
        Check("red.trigger = 'none'"),
        Check("red.brightness", "0"),
        # Animations
        Check(
            "seconds(leds.animate_police_lights, 'RED', 'AMBER', duration=1), now()",
            f"(1.0, {RED + AMBER})",
            "Leds.animate_police_lights",
        ),
        Check(
            "seconds(leds.animate_police_lights, 'RED', 'AMBER', duration=None, block=False)", "0.0"
        ),
        Check(
            "leds.animate_thread_id is None, leds.animate_thread_stop",
            "(False, False)",
            "Leds.animate_thread_id",
        ),
        Check(
            "time.sleep(0.25), seen(3, 0.496)", f"(None, {[RED + AMBER, AMBER + RED, RED + AMBER]})"
        ),
        Check("seconds(leds.animate_stop)", "0.25", "Leds.animate_stop"),
        Check(
            "leds.animate_thread_id, leds.animate_thread_stop",
            "(None, False)",
            "Leds.animate_thread_stop",
        ),
        Check(
            "seconds(leds.animate_flash, 'RED', duration=1), now()",
            f"(1.0, {RED + RED})",
            "Leds.animate_flash",
        ),
        Check("leds.animate_flash('AMBER', ['LEFT'], block=False, duration=2)"),
        Check(
            "time.sleep(0.25), seen(3, 0.496)", f"(None, {[AMBER + RED, OFF + OFF, AMBER + OFF]})"
        ),
        Check(
            "time.sleep(2), leds.animate_thread_id, seconds(leds.all_off), now()",
            f"(None, None, 0.0, {OFF + OFF})",
        ),
        Check(
            "seconds(leds.animate_cycle, ['RED', 'GREEN', 'AMBER'], duration=1), now()",
            f"(1.0, {AMBER + AMBER})",
            "Leds.animate_cycle",
        ),
        Check("leds.animate_cycle(['RED', 'GREEN'], ['RIGHT'], sleeptime=0.2, block=False)"),
        Check(
            "time.sleep(0.1), [led[2:] for led in seen(3, 0.196)]", f"(None, {[RED, GREEN, RED]})"
        ),
        Check("seconds(leds.animate_stop)", "0.1"),
        Check(
            "seconds(leds.animate_rainbow, duration=1), now()",
            f"(1.0, {RED + RED})",
            "Leds.animate_rainbow",
        ),
        Check("leds.animate_rainbow(increment_by=0.5, block=False)"),
        Check(
            "time.sleep(0.05), [led[:2] for led in seen(7, 0.096)]",
            f"(None, {[[127, 0], RED, [255, 127], AMBER, [127, 255], GREEN, [0, 127]]})",
        ),
        Check("leds.animate_cycle(['GREEN'], duration=0, block=False)"),
        Check("seconds(leds.reset), now()", f"(0.0, {GREEN + GREEN})"),
        Check("leds.animate_cycle(['PINK'], block=False)"),
        Check("seconds(leds.animate_stop), leds.animate_thread_id", "(0.0, None)"),
    ),
)
