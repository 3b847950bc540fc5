"""Presses by hand as texts."""

from __future__ import annotations

import pytest

from tests.cases import cases, for_rows
from tuisim.base.errors import ConfigError
from tuisim.engine.core.spec import PRESSABLE
from tuisim.engine.protocol import SetButtons
from tuisim.settings.options import PRESSES, parse
from tuisim.settings.presses import Press, parse_press

GIVEN = {
    "plain": ("enter@1", Press("enter", 1.0, 1.1)),
    "a name of Pybricks": ("center@1", Press("enter", 1.0, 1.1)),
    "held": ("up@0.5-2", Press("up", 0.5, 2.0)),
    "a touch sensor": ("in1@2-2.5", Press("in1", 2.0, 2.5)),
    "every touch sensor": ("touch@2", Press("touch", 2.0, 2.1)),
    "the remote": ("remote.left_up@1-3", Press("remote.left_up", 1.0, 3.0)),
    "from the start": ("backspace@0-0.01", Press("backspace", 0.0, 0.01)),
}


@cases("text, press", GIVEN)
def test_each_form_of_a_planned_press_is_parsed(text: str, press: Press) -> None:
    assert parse_press(text) == press


WRONG = {
    "no time": (
        "enter",
        "--press: must be NAME@FROM or NAME@FROM-UNTIL, got 'enter' (such as enter@1.5)",
    ),
    "no button": ("entre@1", "--press: 'entre' cannot be pressed (did you mean enter?)"),
    "empty": ("@1", f"--press: '' cannot be pressed (one of {', '.join(PRESSABLE)})"),
    "no number": ("up@soon", "--press: must be a number from 0 to 1e+06, got 'soon'"),
    "negative": ("up@-1", "--press: must be a number from 0 to 1e+06, got '-1'"),
    "not a number": ("up@nan", "--press: must be a number from 0 to 1e+06, got 'nan'"),
    "no end": ("up@1-", "--press: must be a number from 0 to 1e+06, got ''"),
    "backwards": (
        "up@2-1",
        "--press: 'up@2-1' ends before it begins (NAME@FROM-UNTIL, in simulated seconds)",
    ),
}


@for_rows("text, message", WRONG)
def test_a_wrong_planned_press_says_what_is_allowed(text: str, message: str) -> None:
    with pytest.raises(ConfigError) as raised:
        parse(PRESSES, text, "--press")
    assert str(raised.value) == message


def test_a_button_that_the_brick_does_not_have_is_refused() -> None:
    with pytest.raises(ConfigError, match="'start' cannot be pressed"):
        SetButtons(("up", "start"))
