"""What Pybricks has on a hub is there, or is refused by name.

`api.json` has the members with the names of their parameters, as the firmware takes them.
"""

from __future__ import annotations

import inspect
import json
import re
from pathlib import Path
from typing import Any

import pytest

from tests.cases import for_each
from tests.engine.shim.pybricks.lab import Lab
from tuisim.base.errors import NotSimulated
from tuisim.engine.core.profile import MotorLaw
from tuisim.engine.shim.pybricks.hub.hubs import PrimeHub
from tuisim.engine.shim.pybricks.hub.pupdevices import Lights
from tuisim.engine.shim.pybricks.modules import read_version_4, refuse_name
from tuisim.engine.shim.pybricks.unsimulated import HUB_CLASSES
from tuisim.engine.shim.pybricks.version_4 import Control

API = json.loads(Path(__file__).with_name("hub").joinpath("api.json").read_text())
PARTS: dict[str, Any] = {"Motor.control": Control, "ColorSensor.lights": Lights}
"""Classes of what an object has."""
NAMES = {
    name: value for names in read_version_4("PrimeHub").values() for name, value in names.items()
}


@pytest.fixture
def hub() -> Any:
    Lab(MotorLaw.PYBRICKS_4, {}, hub="PrimeHub")
    return PrimeHub()


def test_each_member_can_be_called_by_the_names_of_its_parameters(hub: Any) -> None:
    lacking = {}
    for member, parameters in API.items():
        owner, _, name = member.rpartition(".")
        place = (
            getattr(hub, owner.removeprefix("hub."))
            if owner.startswith("hub.")
            else PARTS.get(owner) or NAMES[owner or name]
        )
        called = inspect.signature(getattr(place, name) if owner else place)
        if "named" not in called.parameters:
            lacking[member] = {*parameters} - {*called.parameters}
    assert {member: names for member, names in lacking.items() if names} == {}


@for_each(name=[name for names in HUB_CLASSES.values() for name in names])
def test_creating_a_pybricks_class_that_is_not_simulated_is_refused_by_name(name: str) -> None:
    with pytest.raises(NotSimulated, match=name):
        NAMES[name]()


@pytest.mark.parametrize(
    ("module", "name", "hint"),
    [
        ("pybricks.tools", "hub_menu", "pybricks.tools of PrimeHub has it"),
        ("pybricks.ev3devices", "ForceSensor", "pybricks.pupdevices of PrimeHub has it"),
        ("pybricks.iodevices", "XboxController", "pybricks.iodevices of PrimeHub has it"),
        ("pybricks.experimental", "run_parallel", "multitask() and run_task()"),
    ],
)
def test_a_name_that_the_ev3_lacks_is_refused_with_a_hint(
    module: str, name: str, hint: str
) -> None:
    with pytest.raises(ImportError, match=re.escape(f"{module}.{name}")) as error:
        refuse_name("", module, name)
    assert hint in str(getattr(error.value, "hint", ""))
