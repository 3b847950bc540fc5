"""The brick's six buttons: their state and the events that the library reads."""

from __future__ import annotations

import errno
import types
from collections.abc import Callable, Iterator, MutableSequence
from dataclasses import dataclass
from typing import Any

from tuisim.core.profile import MS, NS_PER_S
from tuisim.protocol import BUTTONS
from tuisim.shim.method_globals import rebind
from tuisim.shim.session import Session
from tuisim.shim.waits import Wait, waits_for

POLL_NS = 10 * MS
"""Interval at which a waiting thread polls the buttons."""
DEVICE_PATH = "/dev/input/event0"
DEVICE_NAME = "EV3 Brick Buttons"
EV_KEY = 1
"""Event type for keys."""
KEY_CODES = dict(zip(BUTTONS, (103, 108, 105, 106, 28, 14), strict=True))
"""Linux key code of each button."""


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
        """Return the simulated time in seconds."""
        return self.sec + self.usec / 1e6


class InputDevice:
    """The buttons as an input device of `evdev`.

    Raises:
        FileNotFoundError: `path` is another path.
    """

    def __init__(self, session: Session, path: str) -> None:
        if path != DEVICE_PATH:
            raise FileNotFoundError(errno.ENOENT, "No such file or directory", path)
        self._session = session
        self.path, self.name = path, DEVICE_NAME

    def active_keys(self) -> list[int]:
        """Return the key codes of the pressed buttons. Charges the cost of a read."""
        return [KEY_CODES[name] for name in read_pressed(self._session)]

    @waits_for(Wait.BUTTON_EVENT)
    def read_loop(self) -> Iterator[InputEvent]:
        """Yield events forever, blocking between them; buttons that are already pressed yield none."""
        session = self._session
        before = session.pressed
        while True:
            now = session.pressed
            for name in BUTTONS:
                if (name in now) != (name in before):
                    at, within = divmod(session.now, NS_PER_S)
                    yield InputEvent(at, within // 1000, EV_KEY, KEY_CODES[name], int(name in now))
            before = now
            session.spend(POLL_NS)


def read_pressed(session: Session) -> list[str]:
    """Return the names of the pressed buttons. Charges the cost of a read."""
    session.command()
    session.charge(session.sim.spec.profile.attribute_read_ns)
    return [name for name in BUTTONS if name in session.pressed]


def evdev_module(session: Session) -> types.ModuleType:
    """Return a module `evdev` whose only device is the brick's buttons."""
    module = types.ModuleType("evdev", "The input devices of the brick: its buttons.")
    codes = {f"KEY_{name.upper()}": code for name, code in KEY_CODES.items()}

    def input_device(path: str) -> InputDevice:
        """Open an input device."""
        return InputDevice(session, path)

    def list_devices() -> list[str]:
        """Return the paths of the input devices."""
        return [DEVICE_PATH]

    vars(module).update(
        InputDevice=input_device,
        InputEvent=InputEvent,
        ecodes=types.SimpleNamespace(EV_KEY=EV_KEY, **codes),
        list_devices=list_devices,
    )
    return module


def patch_button_module(session: Session, module: types.ModuleType) -> None:
    """Patch `ev3dev2.button` after its import: its device file, and waiting by polling every `POLL_NS`."""
    button: Any = module

    def ioctl(_file: object, _request: int, state: MutableSequence[int]) -> int:
        pressed = read_pressed(session)
        bits = sum(1 << KEY_CODES[name] for name in pressed)
        for index, byte in enumerate(bits.to_bytes(len(state), "little")):
            state[index] = byte
        return 0

    def open_device(path: str, _mode: str, _buffering: int) -> str:
        return path

    rebind(button.ButtonEVIO, open=open_device, fcntl=types.SimpleNamespace(ioctl=ioctl))
    button.ButtonEVIO._wait = _polling_wait(session)


def _polling_wait(session: Session) -> Callable[..., bool]:
    between_ns = max(0, POLL_NS - session.sim.spec.profile.attribute_read_ns)

    @waits_for(Wait.BUTTONS)
    def wait(self: Any, to_press: str | list[str], to_release: str | list[str], timeout_ms: float | None) -> bool:
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
