"""Names of version 2.0 of the library that version 4 does not have, and what a program can use instead."""

from __future__ import annotations

from collections.abc import Mapping

_SOUNDS = "its speaker has beep() and play_notes()"
_BRICK = "use the class of the brick or hub in pybricks.hubs"
_PARAMETERS = "pybricks.parameters has it"
_TASKS = "use multitask() and run_task() of pybricks.tools"
_FILES = "Image, Font and ImageFile are in pybricks.parameters, and no sound is a file"
_MAILBOXES = ("Mailbox", "LogicMailbox", "NumericMailbox", "TextMailbox", "MailboxHandlerMixIn")
EARLIER: Mapping[str, Mapping[str, str]] = {
    "pybricks.tools": {
        "DataLog": "print() the values",
        "localtime": "StopWatch tells how long something takes",
        "ticks_us": "StopWatch tells how long something takes",
        "print": "print() needs no import",
    },
    "pybricks.parameters": {
        "SoundFile": _SOUNDS,
        "Align": "draw_image() of the screen takes x and y",
    },
    "pybricks.ev3devices": {"Stop": _PARAMETERS, "CompatMotor": "use Motor"},
    "pybricks.robotics": {
        "Stop": _PARAMETERS,
        "wait": "pybricks.tools has it",
        "CompatDriveBase": "use DriveBase",
    },
    "pybricks.messaging": dict.fromkeys(
        (*_MAILBOXES, "BluetoothMailboxClient", "BluetoothMailboxServer"),
        "leave out its messages: bricks do not talk to each other",
    ),
    "pybricks.iodevices": {"Ev3devSensor": "use the sensors of pybricks.ev3devices"},
}
"""Hints on what to use instead of the names that version 4 of Pybricks no longer has, by module and name."""
EARLIER_MODULES: Mapping[str, str] = {
    "pybricks.display": _BRICK,
    "pybricks.ev3brick": _BRICK,
    "pybricks.experimental": _TASKS,
    "pybricks.media": _FILES,
    "pybricks.media.ev3dev": _FILES,
    "pybricks.speaker": _BRICK,
}
"""Hints on what to use instead of the modules that version 4 of Pybricks no longer has, by module."""
EARLIER_MEMBERS: Mapping[str, str] = {
    "drive_time": "drive(), wait() and stop() do it",
    "orientation": "display.orientation() turns what the matrix shows",
    "play_file": "beep() and play_notes() make sounds",
    "say": "print() shows a text",
    "set_dc_settings": "settings(max_voltage) limits the power",
    "set_pid_settings": "control.pid() sets them",
    "set_run_settings": "control.limits() sets them",
    "set_volume": "volume(percent) sets it",
}
"""Hints on what to use instead of the methods that objects no longer have in version 4 of Pybricks, by the method's
name.
"""


def name_replacement(_owner: str, name: str) -> str:
    """Return what version 4 has in place of an attribute of an earlier version, for the end of an error message.

    An example is `: control.pid() sets them` for `set_pid_settings`. The text is empty for a name without a known
    replacement.
    """
    return f": {EARLIER_MEMBERS[name]}" if name in EARLIER_MEMBERS else ""
