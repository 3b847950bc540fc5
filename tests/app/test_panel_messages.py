"""The brick panel is named once to whoever runs a program that needs it."""

from __future__ import annotations

import pytest

from tests.app.app_help import notices, open_lab, until
from tests.cases import for_rows
from tuisim.app.panel_messages import has_button_calls
from tuisim.app.snapshot import RunPhase

DRAWS = "from ev3dev2.display import Display\nDisplay().update()\n"


@for_rows(
    "text, expected",
    [
        ("import time\nfrom ev3dev2.button import Button\n", True),
        ("from ev3dev2 import button\n", True),
        ("    import ev3dev2.button as b\n", True),
        ("# from ev3dev2.button import Button\nprint('button')\n", False),
        ("from ev3dev2.motor import MoveTank\nbutton = 3\n", False),
        ("if Button.LEFT in ev3.buttons.pressed():\n    pass\n", True),
        ("while not any(brick.buttons()):\n    pass\n", True),
        ("from pybricks.parameters import Button\n# ev3.buttons.pressed()\n", False),
    ],
)
def test_has_button_calls_finds_programs_that_read_the_bricks_buttons(
    text: str, expected: bool
) -> None:
    assert has_button_calls(text) == expected


@pytest.mark.slow
async def test_a_notice_names_the_hidden_brick_panel_once_when_a_program_draws() -> None:
    async with open_lab(DRAWS, speed=0.0, size=(80, 24)) as (pilot, app):
        for _ in range(2):
            await pilot.press("R")
            await until(
                pilot, lambda: app.run_controller.state == RunPhase.ENDED and not app._last_words
            )
        expected = [notice for notice in notices(app) if notice.startswith("The program")]
        assert expected == ["The program uses the brick's display: K opens its panel"]
