"""Input devices: the brick's buttons, which are the only one; opening another raises NotSimulated."""

from __future__ import annotations

import os
import sys
import types
from collections.abc import AsyncIterator, Iterator, Mapping
from contextlib import contextmanager
from typing import Any, NoReturn

from tuisim.base.data_class import dataclass
from tuisim.base.errors import NotSimulated
from tuisim.engine.core.profile import NS_PER_S
from tuisim.engine.runs.readings import GAMEPAD_PORT, READING_CODES
from tuisim.engine.shim.buttons import (
    DEVICE_NAME,
    DEVICE_PATH,
    DEVICE_PATHS,
    EV_KEY,
    KEY_CODES,
    POLL_NS,
    READING_CODE,
    InputEvent,
    changes,
    read_pressed,
)
from tuisim.engine.shim.session import DeviceSession
from tuisim.engine.shim.waits import Wait, waits_for

NAMES: Mapping[str, str] = {
    "EV": """
        SYN KEY REL ABS MSC SW LED=17 SND REP=20 FF PWR FF_STATUS
    """,
    "SYN": """
        REPORT CONFIG MT_REPORT DROPPED
    """,
    "KEY": """
        RESERVED ESC 1 2 3 4 5 6 7 8 9 0 MINUS EQUAL BACKSPACE TAB Q W E R T Y U I O P LEFTBRACE RIGHTBRACE
        ENTER LEFTCTRL A S D F G H J K L SEMICOLON APOSTROPHE GRAVE LEFTSHIFT BACKSLASH Z X C V B N M COMMA
        DOT SLASH RIGHTSHIFT KPASTERISK LEFTALT SPACE CAPSLOCK F1 F2 F3 F4 F5 F6 F7 F8 F9 F10 NUMLOCK
        SCROLLLOCK KP7 KP8 KP9 KPMINUS KP4 KP5 KP6 KPPLUS KP1 KP2 KP3 KP0 KPDOT ZENKAKUHANKAKU=85 102ND F11
        F12 RO KATAKANA HIRAGANA HENKAN KATAKANAHIRAGANA MUHENKAN KPJPCOMMA KPENTER RIGHTCTRL KPSLASH SYSRQ
        RIGHTALT LINEFEED HOME UP PAGEUP LEFT RIGHT END DOWN PAGEDOWN INSERT DELETE MACRO MUTE
        MIN_INTERESTING=113 VOLUMEDOWN VOLUMEUP POWER KPEQUAL KPPLUSMINUS PAUSE SCALE KPCOMMA HANGEUL
        HANGUEL=122 HANJA YEN LEFTMETA RIGHTMETA COMPOSE STOP AGAIN PROPS UNDO FRONT COPY OPEN PASTE FIND
        CUT HELP MENU CALC SETUP SLEEP WAKEUP FILE SENDFILE DELETEFILE XFER PROG1 PROG2 WWW MSDOS COFFEE
        SCREENLOCK=152 ROTATE_DISPLAY DIRECTION=153 CYCLEWINDOWS MAIL BOOKMARKS COMPUTER BACK FORWARD
        CLOSECD EJECTCD EJECTCLOSECD NEXTSONG PLAYPAUSE PREVIOUSSONG STOPCD RECORD REWIND PHONE ISO CONFIG
        HOMEPAGE REFRESH EXIT MOVE EDIT SCROLLUP SCROLLDOWN KPLEFTPAREN KPRIGHTPAREN NEW REDO F13 F14 F15
        F16 F17 F18 F19 F20 F21 F22 F23 F24 PLAYCD=200 PAUSECD PROG3 PROG4 ALL_APPLICATIONS DASHBOARD=204
        SUSPEND CLOSE PLAY FASTFORWARD BASSBOOST PRINT HP CAMERA SOUND QUESTION EMAIL CHAT SEARCH CONNECT
        FINANCE SPORT SHOP ALTERASE CANCEL BRIGHTNESSDOWN BRIGHTNESSUP MEDIA SWITCHVIDEOMODE KBDILLUMTOGGLE
        KBDILLUMDOWN KBDILLUMUP SEND REPLY FORWARDMAIL SAVE DOCUMENTS BATTERY BLUETOOTH WLAN UWB UNKNOWN
        VIDEO_NEXT VIDEO_PREV BRIGHTNESS_CYCLE BRIGHTNESS_AUTO BRIGHTNESS_ZERO=244 DISPLAY_OFF WWAN
        WIMAX=246 RFKILL MICMUTE
    """,
    "BTN": """
        MISC=256 0=256 1 2 3 4 5 6 7 8 9 MOUSE=272 LEFT=272 RIGHT MIDDLE SIDE EXTRA FORWARD BACK TASK
        JOYSTICK=288 TRIGGER=288 THUMB THUMB2 TOP TOP2 PINKIE BASE BASE2 BASE3 BASE4 BASE5 BASE6 DEAD=303
        GAMEPAD SOUTH=304 A=304 EAST B=305 C NORTH X=307 WEST Y=308 Z TL TR TL2 TR2 SELECT START MODE THUMBL
        THUMBR DIGI=320 TOOL_PEN=320 TOOL_RUBBER TOOL_BRUSH TOOL_PENCIL TOOL_AIRBRUSH TOOL_FINGER TOOL_MOUSE
        TOOL_LENS TOOL_QUINTTAP STYLUS3 TOUCH STYLUS STYLUS2 TOOL_DOUBLETAP TOOL_TRIPLETAP TOOL_QUADTAP
        WHEEL GEAR_DOWN=336 GEAR_UP DPAD_UP=544 DPAD_DOWN DPAD_LEFT DPAD_RIGHT
    """,
    "REL": """
        X Y Z RX RY RZ HWHEEL DIAL WHEEL MISC RESERVED WHEEL_HI_RES HWHEEL_HI_RES
    """,
    "ABS": """
        X Y Z RX RY RZ THROTTLE RUDDER WHEEL GAS BRAKE HAT0X=16 HAT0Y HAT1X HAT1Y HAT2X HAT2Y HAT3X HAT3Y
        PRESSURE DISTANCE TILT_X TILT_Y TOOL_WIDTH VOLUME=32 PROFILE MISC=40 RESERVED=46 MT_SLOT
        MT_TOUCH_MAJOR MT_TOUCH_MINOR MT_WIDTH_MAJOR MT_WIDTH_MINOR MT_ORIENTATION MT_POSITION_X
        MT_POSITION_Y MT_TOOL_TYPE MT_BLOB_ID MT_TRACKING_ID MT_PRESSURE MT_DISTANCE MT_TOOL_X MT_TOOL_Y
    """,
}
"""The kernel's names of input events by group, in the order of their numbers; a name without `=` has the number after
that of the name before it.
"""


def numbered(names: str) -> Iterator[tuple[str, int]]:
    """Yield each name in a text with its number: `KEY_A=30 KEY_S` gives `KEY_A` with 30, then `KEY_S` with 31.

    A name without a number gets one more than the name before it; the first name gets 0.
    """
    number = -1
    for word in names.split():
        name, _, given = word.partition("=")
        number = int(given) if given else number + 1
        yield name, number


def codes_module(name: str) -> types.ModuleType:
    """Return a module with the codes of input events, like `evdev.ecodes`.

    The module has a constant for each code, whose value is the code's number. For each group of codes, it also has a
    table of the names by number.

    Args:
        name: The name of the module.
    """
    module = types.ModuleType(name, "Types and codes of input events.")
    codes: dict[str, int] = {}
    tables: dict[str, dict[int, str | list[str]]] = {}
    for group, names in NAMES.items():
        table = tables[group] = {}
        for word, number in numbered(names):
            full = codes[f"{group}_{word}"] = number
            known = table.get(full)
            told = f"{group}_{word}"
            # If a number has several names, evdev gives a list of them.
            table[full] = (
                told if known is None else [*([known] if isinstance(known, str) else known), told]
            )
    keys = {**tables["KEY"], **tables["BTN"]}
    by_type = {codes[f"EV_{group}"]: tables[group] for group in ("SYN", "REL", "ABS")} | {
        codes["EV_KEY"]: keys
    }
    vars(module).update(codes, **tables, ecodes=codes, keys=keys, bytype=by_type)
    return module


_INSTEAD = "to drive by hand, use the brick's buttons or RemoteControlledTank"
ONLY_BUTTONS = (
    f"Gamepads are not simulated: evdev.list_devices() has the brick's buttons only ({_INSTEAD})."
)


@dataclass(frozen=True, slots=True)
class SynEvent:
    """An event that separates others; base class of the events that `categorize` returns."""

    event: InputEvent


class RelEvent(SynEvent):
    """An event with a relative movement, such as that of a mouse."""


class AbsEvent(SynEvent):
    """An event with an absolute position, such as that of a joystick."""


class KeyEvent(SynEvent):
    """An event with a press or release of a key."""

    key_up, key_down, key_hold = 0, 1, 2

    @property
    def scancode(self) -> int:
        """The number of the key that was pressed or released."""
        return self.event.code

    @property
    def keystate(self) -> int:
        """1 if the key was pressed, 0 if it was released."""
        return self.event.value

    @property
    def keycode(self) -> str | list[str]:
        """The name of the key that was pressed or released; a list if the key has several names."""
        names: str | list[str] = _CODES.keys.get(self.event.code, "?")
        return names


_CODES: Any = codes_module("evdev.ecodes")
_KINDS = {
    _CODES.EV_SYN: SynEvent,
    _CODES.EV_KEY: KeyEvent,
    _CODES.EV_REL: RelEvent,
    _CODES.EV_ABS: AbsEvent,
}


def categorize(event: InputEvent) -> SynEvent | InputEvent:
    """Return an event as an object of the class for its type, such as a `KeyEvent`.

    If there is no class for its type, return the event itself.
    """
    kind = _KINDS.get(event.type)
    return event if kind is None else kind(event)


class InputDevice:
    """The buttons as an input device of `evdev`.

    Raises:
        NotSimulated: `dev` is not the path of the buttons.
    """

    def __init__(self, session: DeviceSession, dev: object) -> None:
        path = os.fspath(dev) if isinstance(dev, os.PathLike) else dev
        if path not in DEVICE_PATHS:
            raise NotSimulated(
                f"evdev.InputDevice({path!r}): gamepads and keyboards are not simulated", _INSTEAD
            )
        self._session = session
        self._seen, self._events = session.pressed, list[InputEvent]()
        self.path = self.fn = DEVICE_PATH
        self.name = DEVICE_NAME
        self.phys = "gpio-keys/input0"
        self.uniq = ""
        self.version = 65537

    def capabilities(self, verbose: bool = False, absinfo: bool = True) -> dict[Any, list[Any]]:
        """Return the codes that the device can send, those of the brick's buttons, by the type of event.

        With `verbose`, types and codes are pairs of a name and a number.
        """
        codes = sorted(KEY_CODES.values())
        if verbose:
            return {("EV_KEY", EV_KEY): [(_CODES.KEY[code], code) for code in codes]}
        return {EV_KEY: codes}

    def active_keys(self) -> list[int]:
        """Return the key codes of the pressed buttons, and let the time of a read pass."""
        return [KEY_CODES[name] for name in read_pressed(self._session)]

    def _changes(self) -> list[InputEvent]:
        """Return the button events since the last call of this method."""
        now = self._session.pressed
        before = self._seen
        self._seen = now
        return changes(before, now, self._session.now)

    def read_one(self) -> InputEvent | None:
        """Return the next event; None if there is none. The time of a read passes.

        A button that was pressed and released since the last read is not noticed.
        """
        read_pressed(self._session)
        self._events += self._changes()
        return self._events.pop(0) if self._events else None

    def read(self) -> Iterator[InputEvent]:
        """Return the events since the last read. The time of a read passes.

        Raises:
            BlockingIOError: there is no event.
        """
        first = self.read_one()
        if first is None:
            raise BlockingIOError(11, "Resource temporarily unavailable")
        found = [first, *self._events]
        self._events = []
        return iter(found)

    @waits_for(Wait.BUTTON_EVENT)
    def read_loop(self) -> Iterator[InputEvent]:
        """Yield events forever, and block until each one comes; buttons that are already pressed yield none."""
        self._seen = self._session.pressed
        while True:
            self._session.note_reading(READING_CODE)
            yield from self._changes()
            self._session.spend(POLL_NS)

    async def async_read_loop(self) -> AsyncIterator[InputEvent]:
        """Yield events forever, as `read_loop` does."""
        import asyncio

        self._seen = self._session.pressed
        while True:
            self._session.note_reading(READING_CODE)
            for event in self._changes():
                yield event
            await asyncio.sleep(POLL_NS / NS_PER_S)

    def fileno(self) -> NoReturn:
        """Refuse to give a descriptor, with which a program could wait for events.

        Raises:
            NotSimulated: always.
        """
        raise NotSimulated(
            "evdev.InputDevice.fileno is not part of the simulated brick", "use read_loop()"
        )

    def grab(self) -> None:
        """Do nothing: nobody else reads the buttons."""

    ungrab = close = grab

    @contextmanager
    def grab_context(self) -> Iterator[None]:
        """Do nothing: nobody else reads the buttons."""
        yield

    def __repr__(self) -> str:
        return f"InputDevice({self.path!r})"

    def __str__(self) -> str:
        return f'device {self.path}, name "{self.name}", phys "{self.phys}"'


class UInput:
    """The class with which programs that use evdev create input devices; that is not simulated.

    Raises:
        NotSimulated: always.
    """

    def __init__(self, *_: object, **__: object) -> None:
        raise NotSimulated("evdev.UInput: input devices of a program are not simulated", _INSTEAD)


class _Looked:
    """A flag that says whether the program has listed the input devices."""

    def __init__(self) -> None:
        self.for_devices = False


_looked = _Looked()


def point_at_gamepads(error: BaseException) -> None:
    """Add a note to the error of a program that probably looks for a gamepad: only the brick's buttons exist.

    If the program has not listed the input devices, add no note.
    """
    if _looked.for_devices and isinstance(
        error, NameError | LookupError | AttributeError | StopIteration | TypeError
    ):
        error.add_note(ONLY_BUTTONS)


def evdev_modules(session: DeviceSession) -> dict[str, types.ModuleType]:
    """Return the module `evdev` with its submodules, by name; its only device is the brick's buttons."""

    class Device(InputDevice):
        def __init__(self, dev: object) -> None:
            super().__init__(session, dev)

    Device.__name__ = Device.__qualname__ = "InputDevice"

    def list_devices(input_device_dir: str = "/dev/input") -> list[str]:
        """Return the paths of the input devices."""
        # A call from `ev3dev2.button` looks for the buttons: only other calls can be a search for a gamepad.
        if sys._getframe(1).f_globals.get("__name__") != "ev3dev2.button":
            _looked.for_devices = True
            session.note_reading(READING_CODES[GAMEPAD_PORT, "list"])
        return [DEVICE_PATH]

    def is_device(fn: object) -> bool:
        """Return whether a path is that of an input device."""
        return fn in DEVICE_PATHS

    events = {kind.__name__: kind for kind in (InputEvent, SynEvent, KeyEvent, RelEvent, AbsEvent)}
    parts: dict[str, dict[str, Any]] = {
        "device": {"InputDevice": Device, "EvdevError": type("EvdevError", (Exception,), {})},
        "events": events,
        "util": {"list_devices": list_devices, "is_device": is_device, "categorize": categorize},
        "uinput": {"UInput": UInput, "UInputError": type("UInputError", (Exception,), {})},
    }
    modules = {"evdev": types.ModuleType("evdev", "The input devices of the brick: its buttons.")}
    whole: Any = modules["evdev"]
    whole.__path__ = []
    for name, words in parts.items():
        part = modules[f"evdev.{name}"] = types.ModuleType(f"evdev.{name}")
        vars(part).update(words)
        vars(whole).update(words, **{name: part})
    modules["evdev.ecodes"] = whole.ecodes = _CODES
    whole.event_factory = {kind: of for kind, of in _KINDS.items() if of is not SynEvent}
    return modules
