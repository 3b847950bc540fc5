"""The question before time is left for another future."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.widgets import Static

from tuisim.ui.screens.dialog import Dialog

if TYPE_CHECKING:
    from tuisim.ui.branching import Branch

BRANCH, ANEW = "branch", "anew"


class BranchQuestion(Dialog[str]):
    """Gives `BRANCH`, `ANEW` or None.

    Args:
        branch: What is proposed.
        change: What is different there, in words, or empty.
        in_run: Whether the former run is still going on, and ends with this.
        anew: Whether running from the start is offered.
    """

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("y,enter", "branch", "Branch", show=False),
        Binding("r", "anew", "From the start", show=False),
        Binding("n", "leave", "Stay", show=False),
    ]

    def __init__(self, branch: Branch, change: str, in_run: bool, anew: bool) -> None:
        super().__init__()
        self.TITLE_TEXT = f"Branch from {branch.time_s:.2f} s?"
        self.HINT = "y branches · r runs from the start · n stays" if anew else "y branches · n stays"
        self._anew = anew
        program = "The edited program" if branch.edited else "The program"
        again = "run from its start to there" if branch.edited else "run again to there"
        ends = f" {branch.of.name.capitalize()} ends here, and is kept." if in_run else ""
        then = "goes on from there" if branch.goes_on else "stands still there"
        self._text = f"{program} is {again}, with all that you did until then, and {then}{change}.{ends}"

    def content(self) -> ComposeResult:
        """What would happen, and the answers."""
        yield Static(self._text, markup=False)
        answers = ["[@click=screen.branch]  y  Branch  [/]", "[@click=screen.leave]  n  Stay  [/]"]
        if self._anew:
            answers.insert(1, "[@click=screen.anew]  r  Run from the start  [/]")
        yield Static("   ".join(answers))

    def action_branch(self) -> None:
        """Branch."""
        self.dismiss(BRANCH)

    def action_anew(self) -> None:
        """Run from the start, if that is offered."""
        if self._anew:
            self.dismiss(ANEW)
