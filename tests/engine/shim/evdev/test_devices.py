"""Programs for gamepads find the names of `evdev`, and are told that there are only the brick's buttons."""

from __future__ import annotations

from tests.engine.shim.conftest import RunOn
from tests.running import Run

LOOK = "import evdev\ndevices = [evdev.InputDevice(fn) for fn in evdev.list_devices()]\n"


def test_every_public_name_of_evdev_can_be_imported(run: Run) -> None:
    done = run(
        "from evdev import InputDevice, InputEvent, KeyEvent, UInput, categorize, ecodes, event_factory, list_devices\n"
        "from evdev.events import AbsEvent\nfrom evdev.util import is_device\nimport evdev.ecodes as e\n"
        "pressed, moved = categorize(InputEvent(1, 0, e.EV_KEY, e.BTN_C, 1)), InputEvent(1, 0, e.EV_ABS, e.ABS_X, 9)\n"
        "print(pressed.keycode, pressed.keystate == pressed.key_down, isinstance(categorize(moved), AbsEvent))\n"
        "print(list_devices(), is_device('/dev/input/event3'), event_factory[e.EV_ABS] is AbsEvent)",
        prelude="none",
    )
    assert done.lines == ["BTN_C True True", "['/dev/input/event0'] False True"]


def test_opening_a_gamepad_is_refused(run: Run) -> None:
    done = run(
        "from evdev import InputDevice\npad = InputDevice('/dev/input/event4')", prelude="none"
    )
    assert done.errors[-1] == (
        "NotSimulated: evdev.InputDevice('/dev/input/event4'): gamepads and keyboards are not simulated "
        "(to drive by hand, use the brick's buttons or RemoteControlledTank)"
    )
    assert (done.ended.exit_code, done.ended.error_line) == (1, 2)


def test_creating_an_evdev_device_is_refused(run: Run) -> None:
    assert (
        run("import evdev\nevdev.UInput()", prelude="none")
        .errors[-1]
        .startswith("NotSimulated: evdev.UInput: ")
    )


def test_a_name_error_after_looking_for_a_gamepad_says_that_none_is_simulated(run: Run) -> None:
    text = f"{LOOK}for one in devices:\n    if one.name == 'Wireless Controller':\n        pad = one\npad.grab()"
    done = run(text, prelude="none")
    assert done.errors[-2:] == [
        "NameError: name 'pad' is not defined",
        "Gamepads are not simulated: evdev.list_devices() has the brick's buttons only (to drive by hand, use the "
        "brick's buttons or RemoteControlledTank).",
    ]


def test_another_error_of_a_program_that_reads_buttons_says_nothing_of_gamepads(run: Run) -> None:
    done = run("from ev3dev2.button import Button\nButton().evdev_device\nunknown", prelude="none")
    assert done.errors[-1] == "NameError: name 'unknown' is not defined"


def test_evdev_reads_events_of_the_bricks_buttons_in_order(run_on: RunOn) -> None:
    done = run_on(
        f"{LOOK}import asyncio, time\n(pad,) = devices\nprint(pad.name, pad.read_one())\n"
        "try:\n    pad.read()\nexcept BlockingIOError:\n    print('none')\n"
        "time.sleep(1.5)\nprint([(e.code, e.value) for e in pad.read()], pad.read_one())\n"
        "async def first():\n    async for event in pad.async_read_loop():\n        return event\n"
        "print(asyncio.run(first()).timestamp())",
        presses=("up@1-3", "left@1.2-4"),
    )
    assert done.lines == ["EV3 Brick Buttons None", "none", "[(103, 1), (105, 1)] None", "3.01304"]


def test_waiting_for_the_buttons_event_file_with_select_is_refused(run: Run) -> None:
    done = run(f"{LOOK}import select\nselect.select(devices, [], [])", prelude="none")
    assert done.errors[-1].startswith(
        "NotSimulated: evdev.InputDevice.fileno is not part of the simulated brick"
    )
