"""The brick's six buttons, as the library reads them."""

from __future__ import annotations

import types
from collections.abc import Callable, MutableSequence
from typing import Any

from tuisim.core.profile import MS
from tuisim.protocol import BUTTONS
from tuisim.shim.method_globals import rebind
from tuisim.shim.session import Session
from tuisim.shim.waits import Wait, waits_for

POLL_NS = 10 * MS
"""Interval at which a waiting thread polls the buttons."""
KEY_CODES = dict(zip(BUTTONS, (103, 108, 105, 106, 28, 14), strict=True))
"""Linux key code of each button."""


def read_pressed(session: Session) -> list[str]:
    """Return the names of the pressed buttons. Charges the cost of a read."""
    session.command()
    session.charge(session.sim.spec.profile.attribute_read_ns)
    return [name for name in BUTTONS if name in session.pressed]


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
