"""What errors about unknown names propose; a button that stops the program, as on a hub."""

from __future__ import annotations

import pytest

from tests.engine.shim.conftest import RunOn

PROFILE = "lego-micropython"
HEAD = """
from pybricks.ev3devices import Motor
from pybricks.parameters import Port
m = Motor(Port.B)
"""


def test_an_attribute_that_only_pybricks_4_has_is_refused_with_a_hint(run_on: RunOn) -> None:
    done = run_on(f"{HEAD}m.done()", profile=PROFILE)
    hint = "no attribute 'done': Pybricks 4 has it, which --profile pybricks4 chooses"
    assert hint in done.errors[-1]


@pytest.mark.parametrize("call", ["m.set_u()", "m.stoped()", "m.sett_up"])
def test_an_attribute_error_proposes_no_private_name(run_on: RunOn, call: str) -> None:
    errors = "\n".join(run_on(HEAD + call, profile=PROFILE).errors)
    assert "AttributeError" in errors
    assert "'_" not in errors and "Pybricks 4" not in errors


HUB = """
from pybricks.hubs import PrimeHub
from pybricks.parameters import Button
from pybricks.tools import wait
hub = PrimeHub()
"""


@pytest.mark.parametrize(
    ("text", "presses", "end_ms"),
    [
        ("wait(5000)", ("left@1-1.1", "enter@2-2.1"), 2000),
        ("hub.display.text('A', on=5000)", ("enter@2-2.1",), 2000),
        (
            "for stop in (None, False):\n    hub.system.set_stop_button(stop)\n    wait(1000)",
            ("enter@0.5-1.5",),
            2000,
        ),
        (
            "hub.system.set_stop_button([Button.LEFT, Button.RIGHT])\nwait(3000)",
            ("left@1-2", "right@1.5-2"),
            1500,
        ),
        (
            "hub.system.set_stop_button([Button.LEFT, Button.RIGHT])\nwait(3000)",
            ("left@1-2", "right@2-3"),
            3000,
        ),
    ],
)
def test_a_hub_is_not_stopped_at_once_by_the_buttons_that_stop_it(
    run_on: RunOn, text: str, presses: tuple[str, ...], end_ms: int
) -> None:
    done = run_on(HUB + text, robot="hub", profile="pybricks4", presses=presses)
    assert not done.errors
    assert done.ended.time_ns // 1_000_000 == end_ms
