"""What the code panel asks of the app, and what the editor's keys do."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

from tuisim.ui.editor.work import Work
from tuisim.ui.leaving import TerminalApp

if TYPE_CHECKING:
    from tuisim.ui.app import Lab
    from tuisim.ui.desk import Desk
    from tuisim.ui.panels.code import Code

ROOMY_COLUMNS, ROOMY_ROWS = 86, 15
"""A smaller code panel grows while one types: lines of 79 characters are seen whole."""


class EditorWishes(TerminalApp):
    """The part of the app that answers the code panel; Textual finds the methods by their names."""

    work: Work
    desk: Desk

    def on_code_typing_changed(self, message: Code.TypingChanged) -> None:
        """While one types, the text gets room, and the footer tells the editor's keys."""
        cast("Lab", self).situation_changed()
        if not message.typing:
            self.desk.give_all("")
        else:
            self.desk.make_room("code", ROOMY_COLUMNS, ROOMY_ROWS)

    def on_code_edited(self, message: Code.Edited) -> None:
        """The text was changed."""
        self.work.edited(message.text)
        cast("Lab", self).debugging.edited(message.text)

    def on_code_wanted(self, message: Code.Wanted) -> None:
        """A key of the editor was pressed."""
        match message.what:
            case "save":
                self.work.save()
            case "run":
                cast("Lab", self).action_act("run")
                # The robot is to be seen, or where the text is wrong.
                if self.desk.alone and not (self.desk.code and self.desk.code.error_line):
                    self.desk.give_all("")
            case "new" | "open":
                cast("Lab", self).action_act(message.what)
            case _:
                cast("Lab", self).say("No program to edit: o opens one, ctrl+t begins a new one")


def edit(lab: Lab) -> None:
    """Show the code, and let letters go into it."""
    if not lab.desk.shown("code"):
        lab.desk.toggle("code")
    lab.call_after_refresh(_type, lab)


def _type(lab: Lab) -> None:
    if lab.desk.shown("code") and (code := lab.desk.code):
        # A panel that has just been made has not been given the program yet.
        lab.work.introduce()
        code.start_typing(at_error=True)


def new_program(lab: Lab) -> None:
    """Begin a new program in the code panel."""
    if not lab.desk.shown("code"):
        lab.desk.toggle("code")
    lab.call_after_refresh(lab.work.new)
