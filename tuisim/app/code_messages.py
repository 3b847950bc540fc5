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
"""A code panel smaller than this grows while the user types, so that lines of 79 characters are visible."""


class CodeMessages(TerminalApp):
    """Message handlers of the app for the code panel; Textual finds the methods by name."""

    work: Document
    desk: PanelArea

    def on_code_typing_changed(self, message: Code.TypingChanged) -> None:
        """While the user types, give the code panel room and show the editor's keys in the footer."""
        cast("LabApp", self).situation_changed()
        if not message.typing:
            self.desk.give_all("")
        else:
            self.desk.make_room("code", ROOMY_COLUMNS, ROOMY_ROWS)

    def on_code_edited(self, message: Code.Edited) -> None:
        """Handle an edit of the text."""
        self.work.edited(message.text)
        cast("LabApp", self).debugging.edited(message.text)

    def on_code_wanted(self, message: Code.Wanted) -> None:
        """Handle a key of the editor."""
        match message.what:
            case "save":
                self.work.save()
            case "run":
                cast("LabApp", self).action_act("run")
                # Make the robot visible, or the place of the error in the text.
                if self.desk.alone and not (self.desk.code and self.desk.code.error_line):
                    self.desk.give_all("")
            case "new" | "open":
                cast("LabApp", self).action_act(message.what)
            case _:
                cast("LabApp", self).say("No program to edit: o opens one, ctrl+t begins a new one")
