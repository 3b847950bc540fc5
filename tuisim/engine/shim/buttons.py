"""The brick's six buttons, as the library reads them."""

from __future__ import annotations

import errno
import os
import select
import stat
import struct
import types
from collections.abc import Callable
from typing import Any

from tuisim.base.data_class import dataclass
from tuisim.engine.core.profile import MS, NS_PER_S
from tuisim.engine.core.spec import BUTTONS
from tuisim.engine.runs.readings import BUTTONS_PORT, READING_CODES
from tuisim.engine.shim.files.entries import DeviceFile, OpenFile, refuse_ioctl
from tuisim.engine.shim.session import DeviceSession
from tuisim.engine.shim.waits import Wait, waits_for

POLL_NS = 10 * MS
"""Interval at which a waiting thread polls the buttons."""
DEVICE_PATH = "/dev/input/event0"
DEVICE_PATHS = (DEVICE_PATH, "/dev/input/by-path/platform-gpio_keys-event")
"""All paths of the device file."""
DEVICE_NAME = "EV3 Brick Buttons"
EVENT = struct.Struct("@llHHi")
"""The kernel's `input_event`: seconds, microseconds, type, code, value."""
EV_KEY = 1
"""Event type for keys."""
KEY_CODES = dict(zip(BUTTONS, (103, 108, 105, 106, 28, 14), strict=True))
"""Linux key code of each button."""
KEY_BYTES = 96
"""Bytes of the kernel's set of keys, one bit for each."""
READING_CODE = READING_CODES[BUTTONS_PORT, "pressed"]
"""The code that is recorded when the program reads the buttons."""


@dataclass(frozen=True, slots=True)
class InputEvent:
    """A press or release of a button."""

    sec: int
    usec: int
    type: int
    code: int
    value: int
    """1 for a press, 0 for a release."""

    def timestamp(self) -> float:
        """Return the simulated time of the event in seconds."""
        return self.sec + self.usec / 1e6


def changes(before: frozenset[str], now: frozenset[str], at_ns: int) -> list[InputEvent]:
    """Return the button events between two times at which the buttons were read.

    Args:
        before: The buttons that were pressed at the first time.
        now: The buttons that were pressed at the second time.
        at_ns: The time that the events get.
    """
    at, within = divmod(at_ns, NS_PER_S)
    return [
        InputEvent(at, within // 1000, EV_KEY, KEY_CODES[name], int(name in now))
        for name in BUTTONS
        if (name in now) != (name in before)
    ]


class ButtonsFile(DeviceFile):
    """The device file of the buttons.

    Args:
        session: The session of the run, which knows the time and which buttons are pressed.
        path: The path under which the program opens the file.
    """

    def __init__(self, session: DeviceSession, path: str) -> None:
        super().__init__(path, stat.S_IFCHR | 0o660)
        self._session = session

    def begin(self, opened: OpenFile) -> None:
        """Remember which buttons are pressed when the file is opened; only later changes become events."""
        opened.seen = self._session.pressed

    def read(self, opened: OpenFile, size: int) -> bytes:
        """Return as many whole events as fit into `size` bytes; block until there is one.

        Raises:
            OSError: EINVAL if not even one event fits.
        """
        if size < EVENT.size:
            raise OSError(errno.EINVAL, os.strerror(errno.EINVAL))
        self._session.command()
        self._wait(opened)
        end = size - size % EVENT.size
        part = opened.data[:end]
        opened.data = opened.data[end:]
        return part

    @waits_for(Wait.BUTTON_EVENT)
    def _wait(self, opened: OpenFile) -> None:
        while True:
            self._session.note_reading(READING_CODE)
            if self.ready(opened):
                return
            if not os.get_blocking(opened.fd):
                raise BlockingIOError(errno.EAGAIN, os.strerror(errno.EAGAIN))
            self._session.spend(POLL_NS)

    def ready(self, opened: OpenFile) -> int:
        """Return the flags that `poll` reports: POLLIN if there are unread events, else 0."""
        now = self._session.pressed
        before = opened.seen
        if now is not before:
            assert isinstance(before, frozenset)
            for event in changes(before, now, self._session.now):
                opened.data += EVENT.pack(
                    event.sec, event.usec, event.type, event.code, event.value
                )
                opened.data += EVENT.pack(event.sec, event.usec, 0, 0, 0)
            opened.seen = now
        return select.POLLIN if opened.data else 0

    def ioctl(self, request: int) -> bytes:
        """Return the answer to a request: the pressed keys, one bit for each, or the name of the device."""
        size = request >> 16 & 0x3FFF
        match request & 0xFFFF:
            case 0x4518:
                pressed = read_pressed(self._session)
                return sum(1 << KEY_CODES[name] for name in pressed).to_bytes(
                    max(size, KEY_BYTES), "little"
                )[:size]
            case 0x4506:
                return DEVICE_NAME.encode().ljust(size, b"\0")[:size]
        raise refuse_ioctl(self.path, request, "EVIOCGKEY tells which buttons are pressed")


def read_pressed(session: DeviceSession) -> list[str]:
    """Return the names of the brick's pressed buttons, empty if none is, and let the time of a read pass."""
    session.command()
    if not session.free:
        cost_ns = session.sim.spec.profile.attribute_read_ns
        session.spend(cost_ns, READING_CODE)
    return [name for name in BUTTONS if name in session.pressed]


def patch_button_module(session: DeviceSession, module: types.ModuleType) -> None:
    """Patch `ev3dev2.button` after its import: its waits poll the buttons every `POLL_NS` of simulated time."""
    button: Any = module
    button.ButtonEVIO._wait = _polling_wait(session)


def _polling_wait(session: DeviceSession) -> Callable[..., bool]:
    between_ns = max(0, POLL_NS - session.sim.spec.profile.attribute_read_ns)

    @waits_for(Wait.BUTTONS)
    def wait(
        self: Any, to_press: str | list[str], to_release: str | list[str], timeout_ms: float | None
    ) -> bool:
        """Block until all of `to_press` are pressed and none of `to_release` is; return False after a timeout."""
        wanted = {to_press} if isinstance(to_press, str) else set(to_press)
        unwanted = {to_release} if isinstance(to_release, str) else set(to_release)
        until = None if timeout_ms is None else session.now + round(timeout_ms * MS)
        while True:
            pressed = set(self.buttons_pressed)
            if wanted <= pressed and not unwanted & pressed:
                return True
            rest_ns = between_ns
            if until is not None:
                if session.now >= until:
                    return False
                rest_ns = min(rest_ns, until - session.now)
            session.spend(rest_ns)

    return wait
