"""Types and codes of input events, as the kernel numbers them; the module `evdev.ecodes`."""

from __future__ import annotations

import types
from collections.abc import Iterator, Mapping

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
"""Names by group, in the order of their numbers; a name without a number has the one after its predecessor's."""


def numbered(names: str) -> Iterator[tuple[str, int]]:
    """Yield names with their numbers: `NAME=5` gives its own, other names count on from the one before."""
    number = -1
    for word in names.split():
        name, _, given = word.partition("=")
        number = int(given) if given else number + 1
        yield name, number


def codes_module(name: str) -> types.ModuleType:
    """Return the module that has the number of each name, and for each group a table of names by number."""
    module = types.ModuleType(name, "Types and codes of input events.")
    codes: dict[str, int] = {}
    tables: dict[str, dict[int, str | list[str]]] = {}
    for group, names in NAMES.items():
        table = tables[group] = {}
        for word, number in numbered(names):
            full = codes[f"{group}_{word}"] = number
            known = table.get(full)
            told = f"{group}_{word}"
            # Of a number with several names, evdev lists all.
            table[full] = (
                told if known is None else [*([known] if isinstance(known, str) else known), told]
            )
    keys = {**tables["KEY"], **tables["BTN"]}
    by_type = {codes[f"EV_{group}"]: tables[group] for group in ("SYN", "REL", "ABS")} | {
        codes["EV_KEY"]: keys
    }
    vars(module).update(codes, **tables, ecodes=codes, keys=keys, bytype=by_type)
    return module
