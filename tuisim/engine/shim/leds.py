"""The brick's four LEDs, as the kernel's generic driver exposes them, and the library's animations.

An LED whose trigger is `timer` blinks in simulated time, in a thread of its own.
"""

from __future__ import annotations

import _thread
import errno
import types
from collections.abc import Callable, Mapping
from functools import wraps
from itertools import count
from typing import Any

from tuisim.engine.core.profile import MS, NS_PER_S
from tuisim.engine.runs.brick_state import LED_NAMES, build_led_row
from tuisim.engine.runs.records import Stream
from tuisim.engine.shim.device_files import SimDevice, refuse
from tuisim.engine.shim.method_globals import rebind
from tuisim.engine.shim.session import DeviceSession

LED_CLASS = "leds"
"""The kernel's name of the class of LEDs, a folder of `/sys/class`."""
MAX_BRIGHTNESS = 255
TRIGGERS = ("none", "timer", "default-on")
BLINK_MS = 500
"""Default duration in ms of each phase, on or off, of a blinking LED."""
STOP_POLL_NS = MS
"""Simulated time between two checks of `animate_stop` whether the animation has ended."""


def led_name(name: str) -> str:
    """Return the kernel's name of an LED; for `left red`, one of `LED_NAMES`, it is `led0:red:brick-status`."""
    side, color = name.split()
    return f"led{('left', 'right').index(side)}:{color}:brick-status"


class Lights:
    """All LEDs of the brick. Each change of their brightness is recorded."""

    def __init__(self, session: DeviceSession) -> None:
        self.session = session
        self.lights = {name: Light(self, green=name.endswith("green")) for name in LED_NAMES}
        self._shown = self._brightness()

    def _brightness(self) -> dict[str, int]:
        return {name: light.shining for name, light in self.lights.items()}

    def shine(self, brightness: Mapping[str, int]) -> None:
        """Set the brightness of some LEDs, from 0 to 255, by their names in `LED_NAMES`, and record the change."""
        for name, value in brightness.items():
            self.lights[name].shining = value
        self.show()

    def show(self) -> None:
        """Record the brightness of the LEDs if it has changed."""
        brightness = self._brightness()
        if brightness != self._shown:
            self._shown = brightness
            self.session.show(build_led_row(brightness), Stream.LED)


class Light:
    """One LED of the brick; a green one is on when the program starts."""

    def __init__(self, lights: Lights, green: bool) -> None:
        self._lights = lights
        self.shining = MAX_BRIGHTNESS if green else 0
        self._trigger = "default-on" if green else "none"
        self._blink_brightness = 0
        self._delays_ms = {"delay_on": 0, "delay_off": 0}
        self._blink = 0
        """How often the blinking was set anew; a thread that blinks the LED ends when this number has changed."""

    def device(self) -> SimDevice:
        """Return the LED as a device of `/sys/class/leds`."""
        return SimDevice(
            self._lights.session,
            {
                "brightness": lambda: self.shining,
                "max_brightness": lambda: MAX_BRIGHTNESS,
                "trigger": self._triggers,
                "delay_on": lambda: self._delay("delay_on"),
                "delay_off": lambda: self._delay("delay_off"),
            },
            {"trigger": self._set_trigger},
            number_writers={
                "brightness": self._set_brightness,
                "delay_on": lambda value: self._set_delay("delay_on", value),
                "delay_off": lambda value: self._set_delay("delay_off", value),
            },
            temporary=self._delays_ms,
        )

    def _triggers(self) -> str:
        return " ".join(f"[{name}]" if name == self._trigger else name for name in TRIGGERS)

    def _shine(self, brightness: int) -> None:
        self.shining = brightness
        self._lights.show()

    def _set_brightness(self, value: int) -> None:
        if value < 0:
            raise refuse(str(value))
        self._lights.session.command()
        value = min(value, MAX_BRIGHTNESS)
        if value and self._trigger == "timer":
            self._blink_brightness = value
            if self.shining:
                self._shine(value)
            return
        if not value:
            # As in the kernel, brightness 0 also turns the trigger off.
            self._trigger = "none"
        self._shine(value)

    def _set_trigger(self, text: str) -> None:
        if text not in TRIGGERS:
            raise refuse(text)
        self._lights.session.command()
        before = self._trigger
        self._trigger = text
        if text == "timer":
            self._blink_brightness = self.shining or MAX_BRIGHTNESS
            self._delays_ms = dict.fromkeys(self._delays_ms, BLINK_MS)
            self._start_blinking()
        elif text == "default-on":
            self._shine(MAX_BRIGHTNESS)
        elif before != "none":
            self._shine(0)

    def _delay(self, name: str) -> int:
        if self._trigger != "timer":
            raise OSError(errno.ENOENT, name)
        return self._delays_ms[name]

    def _set_delay(self, name: str, value: int) -> None:
        self._delay(name)
        if value < 0:
            raise refuse(str(value))
        self._lights.session.command()
        self._delays_ms[name] = value
        self._start_blinking()

    # Blinking

    def _start_blinking(self) -> None:
        self._blink += 1
        on_ms, off_ms = self._delays_ms.values()
        if on_ms and off_ms:
            _thread.start_new_thread(self._keep_blinking, (self._blink,))
        else:
            self._shine(self._blink_brightness if on_ms else 0)

    def _keep_blinking(self, blink: int) -> None:
        # The thread sleeps by waiting for a lock that is never released: unlike a sleep, this does not count as a line
        # of the program that takes time.
        alarm = _thread.allocate_lock()
        alarm.acquire()
        lit = True
        while blink == self._blink and self._trigger == "timer":
            self._shine(self._blink_brightness if lit else 0)
            alarm.acquire(True, self._delays_ms["delay_on" if lit else "delay_off"] * MS / NS_PER_S)
            lit = not lit


def patch_led_module(session: DeviceSession, module: types.ModuleType) -> None:
    """Patch `ev3dev2.led` after its import: its animations run, and are waited for, in simulated time."""
    led: Any = module
    numbers = count(1)
    running: dict[int, int] = {}
    """The identity of the thread that runs each animation, by the animation's number."""

    def start_new_thread(function: Callable[..., None], arguments: tuple[Any, ...]) -> int:
        number = next(numbers)

        def animate() -> None:
            running[number] = _thread.get_ident()
            try:
                function(*arguments)
            finally:
                del running[number]

        _thread.start_new_thread(animate, ())
        return number

    def animate_stop(self: Any) -> None:
        """End the animation of the LEDs, and block until its thread has ended."""
        number = self.animate_thread_id
        # A flashing animation calls this from its own thread to turn the LEDs off: it must not wait for itself.
        if number is None or running.get(number) == _thread.get_ident():
            return
        self.animate_thread_stop = True
        while number in running:
            session.spend(STOP_POLL_NS)
        # The animation resets these attributes at its end, but not if an error has ended it.
        self.animate_thread_id, self.animate_thread_stop = None, False

    rebind(led.Leds, _thread=types.SimpleNamespace(start_new_thread=start_new_thread))
    led.Leds.animate_stop = animate_stop
    if session.sim.spec.profile.mend_library:
        mend_trigger(led.Led)


def mend_trigger(led_class: Any) -> None:
    """Fix the library's property `trigger` of an LED, which fails: it expects two values where it reads only one."""

    @wraps(led_class.trigger.fget)
    def get_trigger(self: Any) -> str:
        return str(self.get_attr_from_set(None, "trigger"))

    led_class.trigger = led_class.trigger.getter(get_trigger)
