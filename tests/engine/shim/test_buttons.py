"""Checks of the brick's buttons while somebody presses them."""

from __future__ import annotations

from tests.engine.shim.checking import Check, Table, Tables, cases, check
from tests.engine.shim.conftest import RunOn

PRESSES = (
    "up@1-2",
    "enter@1.5-2.5",
    *(
        f"{name}@{3 + at}-{3.5 + at}"
        for at, name in enumerate(("up", "down", "left", "right", "enter", "backspace"))
    ),
    "left@10-10.5",
    "right@11-12",
    "enter@11.5-12.5",
    "down@20-21",
    "left@21.2-21.3",
    "up@30-31",
    "up@31.5-32",
    "enter@33",
    "left@35-36",
    "down@40-41",
)

SETUP = """\
import time, _thread
import evdev
from ev3dev2.button import *
from ev3dev2.button import platform
b = Button()
told = []
b.on_change = lambda changes: told.append(sorted(changes))

def until(seconds):
    time.sleep(seconds - time.monotonic())

def at(seconds):
    until(seconds)
    return b.buttons_pressed

def when(call, *words):
    start = time.monotonic()
    return call(*words), round(time.monotonic() - start, 2)

class Half(ButtonEVIO):
    _buttons = {'shift': {'name': None, 'value': 1}}

class Grown(ButtonCommon, EV3ButtonCommon):
    buttons_pressed = ['up', 'left']
"""

NAMES = ("up", "down", "left", "right", "enter", "backspace")

BUTTON = Table(
    "ev3dev2.button",
    SETUP,
    (
        Check(
            "platform, BUTTONS_FILENAME, EVDEV_DEVICE_NAME, Button.evdev_device_name",
            "('ev3', '/dev/input/by-path/platform-gpio_keys-event', 'EV3 Brick Buttons', 'EV3 Brick Buttons')",
            "platform BUTTONS_FILENAME EVDEV_DEVICE_NAME Button.evdev_device_name",
        ),
        Check(
            "ButtonEVIO.KEY_MAX, ButtonEVIO.KEY_BUF_LEN, hex(ButtonEVIO.EVIOCGKEY)",
            "(767, 96, '0x80604518')",
            "ButtonEVIO.KEY_MAX ButtonEVIO.KEY_BUF_LEN ButtonEVIO.EVIOCGKEY",
        ),
        Check(
            "Half()",
            "MissingButton: Button 'shift' is not available on this platform",
            "MissingButton",
        ),
        Check(
            "Grown().up, Grown().any(), Grown().down, str(Grown())",
            "(True, True, False, 'Grown')",
            "ButtonCommon EV3ButtonCommon",
        ),
        Check("ButtonCommon().buttons_pressed", "NotImplemented", "ButtonCommon.buttons_pressed"),
        Check(
            "ButtonCommon.on_change([]), ButtonBase().process(set())",
            "(None, None)",
            "ButtonCommon.on_change ButtonBase",
        ),
        Check(
            "str(b), b.on_up, b.on_down, b.on_left, b.on_right, b.on_enter, b.on_backspace",
            "('Button', None, None, None, None, None, None)",
            "Button ButtonEVIO ButtonCommon.__str__",
        ),
        Check(
            "b.buttons_pressed, b.any(), b.check_buttons(), b.check_buttons(['up'])",
            "([], False, True, False)",
        ),
        Check("b.buttons_pressed = []", "AttributeError"),
        # Two buttons
        Check(
            "[at(t) for t in (1.1, 1.6, 2.1, 2.6)]",
            "[['up'], ['up', 'enter'], ['enter'], []]",
            "ButtonEVIO.__init__ ButtonEVIO.buttons_pressed",
        ),
        *(
            Check(
                f"(at({3.2 + index}), b.{name}, b.any(), b.check_buttons(['{name}']), b.check_buttons([]), "
                f"[n for n in {NAMES} if getattr(b, n)])",
                f"(['{name}'], True, True, True, False, ['{name}'])",
                f"EV3ButtonCommon.{name} ButtonCommon.any ButtonCommon.check_buttons",
            )
            for index, name in enumerate(NAMES)
        ),
        # Waiting
        Check(
            "until(9.5), when(b.wait_for_pressed, 'left', 1000)",
            "(None, (True, 0.51))",
            "ButtonCommon.wait_for_pressed",
        ),
        Check("when(b.wait_for_pressed, ['left'])", "(True, 0.0)"),
        Check(
            "when(b.wait_for_released, 'left', 100)",
            "(False, 0.1)",
            "ButtonCommon.wait_for_released",
        ),
        Check("when(b.wait_for_released, ['left', 'up'])", "(True, 0.4)"),
        Check("when(b.wait_for_released, 'left')", "(True, 0.0)"),
        Check("until(11), when(b.wait_for_pressed, ['right', 'enter'])", "(None, (True, 0.51))"),
        Check("when(b.wait_for_released, ['right', 'enter'])", "(True, 1.0)"),
        Check("when(b.wait_for_pressed, 'up', 0)", "(False, 0.0)"),
        Check(
            "until(19.5), when(b.wait_for_bump, 'down', 2000)",
            "(None, (True, 1.51))",
            "ButtonCommon.wait_for_bump",
        ),
        Check("when(b.wait_for_bump, 'left', 250), b.left", "((False, 0.25), True)"),
        Check("when(b.wait_for_bump, 'left', 100)", "(True, 0.05)"),
        Check("when(b.wait_for_bump, 'left', 100)", "(False, 0.1)"),
        # Handlers
        Check("b.process(), told", "(None, [])", "ButtonCommon.process"),
        *(
            Check(
                f"b.on_{name} = lambda state: told.append('{name}' if state else 'no {name}'); "
                f"b.process({{'{name}'}}); b.process(set())"
            )
            for name in NAMES
        ),
        *(
            Check(
                "told[:4], told.__delitem__(slice(0, 4))",
                f"(['{name}', [('{name}', True)], 'no {name}', [('{name}', False)]], None)",
                f"EV3ButtonCommon.on_{name} ButtonCommon.on_change",
            )
            for name in NAMES
        ),
        Check(
            "until(30.5), b.process(), b.process(), told",
            "(None, None, None, ['up', [('up', True)]])",
        ),
        Check("until(31.2), b.process(), told[2:]", "(None, None, ['no up', [('up', False)]])"),
        Check(
            "told.clear(), _thread.start_new_thread(b.process_forever, ()) > 0",
            "(None, True)",
            "ButtonBase.process_forever",
        ),
        Check(
            "until(34), told",
            "(None, ['up', [('up', True)], 'no up', [('up', False)], 'enter', [('enter', True)], "
            "'no enter', [('enter', False)]])",
        ),
        # Events
        Check("d = b.evdev_device"),
        Check(
            "d.name, d.path, evdev.list_devices(), d.active_keys()",
            "('EV3 Brick Buttons', '/dev/input/event0', ['/dev/input/event0'], [])",
            "ButtonBase.evdev_device",
        ),
        Check(
            "evdev.InputDevice('/dev/input/event7')",
            "NotSimulated: evdev.InputDevice('/dev/input/event7'): gamepads and keyboards are not simulated",
        ),
        Check("events = d.read_loop()"),
        Check(
            "[(e.type == evdev.ecodes.EV_KEY, e.code == evdev.ecodes.KEY_LEFT, e.value, round(e.timestamp(), 1)) "
            "for e in (next(events), next(events))]",
            "[(True, True, 1, 35.0), (True, True, 0, 36.0)]",
        ),
        Check("until(40.5), d.active_keys() == [evdev.ecodes.KEY_DOWN]", "(None, True)"),
    ),
    PRESSES,
)


TABLES: Tables = {
    "buttons": (BUTTON, "plain", "empty"),
}


@cases(TABLES)
def test_buttons_read_as_the_table_says(
    run_on: RunOn, table: Table, robot: str, world: str
) -> None:
    check(run_on, table, robot, world)
