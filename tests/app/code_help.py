"""The code panel alone, for tests."""

from __future__ import annotations

from typing import Any

from textual.pilot import Pilot

from tests.app.panel_help import PanelApp
from tuisim.app.editor.area import CodeArea
from tuisim.app.panels.code import Code

TEXT = "print('A: 1')\nfor n in range(3):\n    print('B: ' + str(n))\n"


class CodeApp(PanelApp[Code]):
    """The code panel alone."""

    def __init__(self) -> None:
        super().__init__(Code())
        self.wishes: list[int | str] = []

    def on_code_breakpoint_toggled(self, message: Code.BreakpointToggled) -> None:
        """Keep the line."""
        self.wishes.append(message.line)

    def on_code_wanted(self, message: Code.Wanted) -> None:
        """Keep what is wanted."""
        self.wishes.append(message.command)


async def alone(pilot: Pilot[Any], text: str = TEXT) -> tuple[Code, CodeArea]:
    code = pilot.app.query_one(Code)
    code.set_program("prog.py", text, "prog")
    area = code.query_one(CodeArea)
    area.focus()
    await pilot.pause()
    return code, area
