"""Motors as the browser simulator has them: set points, states, and numbers with all their digits."""

from __future__ import annotations

import pytest

from tests.cases import cases
from tests.engine.shim.conftest import RunOn
from tuisim.engine.shim.ev3dev.browser_library import round_half_up

MOTOR = "from ev3dev2.motor import *\nm, t = LargeMotor('outB'), MoveTank('outB', 'outC')\n"


@pytest.mark.parametrize("number, rounded", [(2.5, 3), (-2.5, -2), (2.4, 2), (-0.6, -1)])
def test_round_half_up_rounds_halves_up_also_below_zero(number: float, rounded: int) -> None:
    assert round_half_up(number) == rounded


SHOWN = {
    "the speed in place of the time, as there": (
        "m.on_for_seconds(20, 1.5, block=False)\nprint(m.time_sp)",
        ["210"],
    ),
    "states": ("print([m.state])\nm.on(20)\nprint(m.state)", ["['']", "running"]),
    "speeds without a sign": (
        "m.on_for_degrees(-20, 90, block=False)\nprint(m.position_sp, m.speed_sp)",
        ["-90 210"],
    ),
    "whole turns a second": (
        "print(m.max_rps, m.max_rpm, m.max_dps, m.max_dpm)",
        ["2.0 120.0 720.0 43200.0"],
    ),
    "a move of no time": ("t.on_for_seconds(20, 20, 0)\nprint('over')", ["over"]),
}


@cases("text, lines", SHOWN)
def test_a_motor_reads_as_in_the_browser_simulator(
    run_on: RunOn, text: str, lines: list[str]
) -> None:
    done = run_on(MOTOR + text, profile="nbev3devsim")
    assert (done.lines, done.errors) == (lines, [])


@pytest.mark.parametrize("call", ["m.on_for_seconds(20, -1)", "t.on_for_seconds(20, 20, -1)"])
def test_a_negative_time_is_refused(run_on: RunOn, call: str) -> None:
    assert (
        run_on(MOTOR + call, profile="nbev3devsim").errors[-1]
        == "ValueError: seconds is negative (-1)"
    )
