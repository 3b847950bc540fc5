"""What a hub tells of itself and of its charger."""

from __future__ import annotations

from typing import Any

import pytest

from tests.engine.shim.pybricks.lab import Lab
from tuisim.engine.core.profile import MotorLaw
from tuisim.engine.shim.pybricks.hub.hubs import PrimeHub


def test_a_hub_tells_what_programs_look_up() -> None:
    Lab(MotorLaw.PYBRICKS_4, {}, hub="PrimeHub")
    hub: Any = PrimeHub()
    assert repr(hub.charger.connected()) == "0"
    assert hub.system.info().keys() == {
        *("name", "reset_reason", "host_connected_ble", "host_connected_usb"),
        *("program_id", "program_start_type"),
    }


def test_a_hubs_storage_is_either_read_or_written() -> None:
    Lab(MotorLaw.PYBRICKS_4, {}, hub="PrimeHub")
    hub: Any = PrimeHub()
    hub.system.storage(3, write=b"abc")
    assert hub.system.storage(2, read=3) == b"\0ab"
    for wrong in ({}, {"read": 3, "write": b"abc"}):
        with pytest.raises(TypeError):
            hub.system.storage(0, **wrong)
