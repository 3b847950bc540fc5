"""What errors about unknown names propose."""

from __future__ import annotations

import pytest

from tests.engine.shim.conftest import RunOn

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
