"""The numbers of events are those of the kernel's header."""

from __future__ import annotations

from typing import Any

from tests.cases import for_rows
from tuisim.engine.shim.evdev.devices import codes_module, numbered

CODES: Any = codes_module("evdev.ecodes")


@for_rows(
    "name, number",
    [
        ("EV_SYN", 0),
        ("EV_FF", 21),
        ("SYN_DROPPED", 3),
        ("KEY_ESC", 1),
        ("KEY_UP", 103),
        ("KEY_102ND", 86),
        ("KEY_F24", 194),
        ("KEY_MICMUTE", 248),
        ("BTN_LEFT", 0x110),
        ("BTN_SOUTH", 0x130),
        ("BTN_A", 0x130),
        ("BTN_THUMBR", 0x13E),
        ("BTN_TOUCH", 0x14A),
        ("BTN_DPAD_UP", 0x220),
        ("REL_WHEEL", 8),
        ("ABS_HAT0Y", 17),
        ("ABS_MT_POSITION_X", 53),
    ],
)
def test_evdev_event_codes_have_the_kernels_numbers(name: str, number: int) -> None:
    assert (getattr(CODES, name), CODES.ecodes[name]) == (number, number)


def test_evdev_event_names_are_found_by_number() -> None:
    assert (CODES.KEY[103], CODES.bytype[CODES.EV_ABS][0], CODES.keys[CODES.BTN_B]) == (
        "KEY_UP",
        "ABS_X",
        ["BTN_EAST", "BTN_B"],
    )


def test_an_event_name_without_a_number_gets_the_next_one() -> None:
    assert list(numbered("A B=7 C")) == [("A", 0), ("B", 7), ("C", 8)]
