"""What errors about unknown names propose; a button that stops the program, as on a hub."""

from __future__ import annotations

import pytest

from tests.engine.shim.conftest import RunOn
from tests.engine.shim.pybricks.lab import Lab
from tuisim.engine.core.profile import MotorLaw
from tuisim.engine.shim.pybricks.hub.hubs import PrimeHub
from tuisim.engine.shim.pybricks.hub.parameters import Button
from tuisim.engine.shim.pybricks.tools import wait

PROFILE = "lego-micropython"
HEAD = """
from pybricks.ev3devices import Motor
from pybricks.parameters import Port
m = Motor(Port.B)
"""


def test_a_name_that_version_4_has_is_told_of(run_on: RunOn) -> None:
    done = run_on(f"{HEAD}m.done()", profile=PROFILE)
    hint = "no attribute 'done': Pybricks 4 has it, which --profile pybricks4 chooses"
    assert hint in done.errors[-1]


@pytest.mark.parametrize("call", ["m.set_u()", "m.stoped()", "m.sett_up"])
def test_no_private_name_is_proposed(run_on: RunOn, call: str) -> None:
    errors = "\n".join(run_on(HEAD + call, profile=PROFILE).errors)
    assert "AttributeError" in errors
    assert "'_" not in errors and "Pybricks 4" not in errors


@pytest.fixture
def lab() -> Lab:
    return Lab(MotorLaw.PYBRICKS_4, {}, hub="PrimeHub")


def test_the_centre_button_stops_a_program_on_a_hub(lab: Lab) -> None:
    PrimeHub()
    lab.pressed = frozenset({"left"})
    wait(10)
    lab.pressed = frozenset({"enter"})
    with pytest.raises(SystemExit):
        wait(10)


def test_a_program_can_keep_the_centre_button_for_itself(lab: Lab) -> None:
    hub = PrimeHub()
    lab.pressed = frozenset({"enter"})
    hub.system.set_stop_button(None)
    wait(10)
    assert hub.buttons.pressed() == {Button.CENTER}
    hub.system.set_stop_button((Button.CENTER, Button.BLUETOOTH))
    with pytest.raises(SystemExit):
        hub.buttons.pressed()
