"""Handlers of the messages that the code panel sends."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

from tuisim.app.editor.document import Document
from tuisim.app.terminal.terminal_app import TerminalApp

if TYPE_CHECKING:
    from tuisim.app.app import LabApp
    from tuisim.app.panel_area import PanelArea
    from tuisim.app.panels.code import Code


ROOMY_COLUMNS, ROOMY_ROWS = 86, 15
"""A smaller code panel grows while one types: lines of 79 characters are seen whole."""


class CodeMessages(TerminalApp):
    """The part of the app that answers the code panel; Textual finds the methods by their names."""

    work: Document
    desk: PanelArea

    def on_code_typing_changed(self, message: Code.TypingChanged) -> None:
        """While one types, the text gets room, and the footer tells the editor's keys."""
        cast("LabApp", self).situation_changed()
        if not message.typing:
            self.desk.give_all("")
        else:
            self.desk.make_room("code", ROOMY_COLUMNS, ROOMY_ROWS)

    def on_code_edited(self, message: Code.Edited) -> None:
        """The text was changed."""
        self.work.edited(message.text)
        cast("LabApp", self).debugging.edited(message.text)

    def on_code_wanted(self, message: Code.Wanted) -> None:
        """A key of the editor was pressed."""
        match message.what:
            case "save":
                self.work.save()
            case "run":
                cast("LabApp", self).action_act("run")
                # The robot is to be seen, or where the text is wrong.
                if self.desk.alone and not (self.desk.code and self.desk.code.error_line):
                    self.desk.give_all("")
            case "new" | "open":
                cast("LabApp", self).action_act(message.what)
            case _:
                cast("LabApp", self).say("No program to edit: o opens one, ctrl+t begins a new one")
