"""Dialogs that ask: questions with a few answers, each with a key and a clickable word, and a line of text."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, ClassVar

from rich.table import Table
from textual import events, on
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.suggester import SuggestionReady
from textual.widgets import Input, Static

from tuisim.app.action import KeyWord
from tuisim.app.dialogs.dialog import Dialog
from tuisim.base.errors import TuisimError
from tuisim.terminal.text_runs import escape_markup

if TYPE_CHECKING:
    from tuisim.app.branch import Branch

Answer = tuple[str, str]
"""The key that chooses the answer, which is also what the dialog returns, and what the answer does, in words."""


def _compose_answers(answers: Iterable[tuple[str, str, str]]) -> Iterator[Static]:
    """Yield an empty row, and the row of answers.

    Args:
        answers: For each answer the action of the dialog, the key, and in words what the answer does.
    """
    yield Static()
    words = (f"[@click=screen.{action}]  {key}  {does}  [/]" for action, key, does in answers)
    yield Static("   ".join(words), classes="link")


class Question(Dialog[str]):
    """The dialog with a question; it returns the key of the chosen answer, None on Escape.

    Args:
        title: The subject.
        text: The question.
        answers: The key of each answer, and what it does, in words; Enter chooses the first one.
        escape: What Escape does, in words.
    """

    def __init__(
        self, title: str, text: str, answers: Sequence[Answer], escape: str = "decides later"
    ) -> None:
        super().__init__()
        self.HINT = f"Escape {escape}"
        self.TITLE_TEXT = escape_markup(title)
        self._text = text
        self._answers = answers

    def compose_content(self) -> ComposeResult:
        yield Static(self._text, markup=False)
        yield from _compose_answers((f"answer('{key}')", key, does) for key, does in self._answers)

    @property
    def keys(self) -> tuple[KeyWord, ...]:
        """The keys of the answers, then Escape, for the footer."""
        return (*((key, does[:1].lower() + does[1:]) for key, does in self._answers), *super().keys)

    def on_key(self, event: events.Key) -> None:
        key = self._answers[0][0] if event.key == "enter" else event.key
        if key in dict(self._answers):
            event.stop()
            self.action_answer(key)

    def action_answer(self, key: str) -> None:
        self.dismiss(key)


BRANCH = "branch"
RESTART = "restart"


class BranchQuestion(Dialog[str]):
    """The dialog that asks whether to start a branch: a new run that repeats a former run up to an instant.

    It returns `BRANCH`, `RESTART` for a run of the program from its start, or None.

    Args:
        branch: The proposed branch.
        change: What the user changes at that instant, in words; empty for nothing.
        in_run: Whether the former run is still live; it ends when the branch starts.
        restart: Whether to offer a run of the program from its start.
    """

    BINDINGS: ClassVar[list[BindingType]] = [
        ("y", "branch", "Branch"),
        ("enter", "likely"),
        ("r", "restart", "From the start"),
        ("n", "leave", "Stay"),
    ]

    def __init__(self, branch: Branch, change: str, in_run: bool, restart: bool) -> None:
        super().__init__()
        self.TITLE_TEXT = f"Branch from {branch.time_s:.2f} s?"
        self.HINT = (
            "y branches · r runs from the start · n stays" if restart else "y branches · n stays"
        )
        self._restart = restart
        self._is_edited = branch.edited
        program = "The edited program" if branch.edited else "The program"
        again = (
            "runs from its start to this instant"
            if branch.edited
            else "runs again up to this instant"
        )
        ends = f" {branch.of.name.capitalize()} ends now and is stored." if in_run else ""
        then = "continues from here" if branch.goes_on else "pauses here"
        self._text = (
            f"{program} {again}, with all your actions until then, and {then}{change}.{ends}"
        )

    def compose_content(self) -> ComposeResult:
        yield Static(self._text, markup=False)
        answers = [
            ("branch", "y", "Branch"),
            ("restart", "r", "Run from the start"),
            ("leave", "n", "Stay"),
        ]
        # A user who has edited the program usually wants to run it from its start: that answer comes first.
        answers[:2] = answers[1::-1] if self._is_edited else answers[:2]
        yield from _compose_answers(
            answer for answer in answers if self._restart or answer[0] != "restart"
        )

    @property
    def keys(self) -> tuple[KeyWord, ...]:
        """The keys of the offered answers, then Escape, for the footer."""
        return tuple(word for word in super().keys if self._restart or word[0] != "r")

    def action_likely(self) -> None:
        """Close the dialog with the answer that the user most likely wants.

        This is `RESTART` if a restart is offered and the program was edited, else `BRANCH`.
        """
        self.dismiss(RESTART if self._restart and self._is_edited else BRANCH)

    def action_branch(self) -> None:
        self.dismiss(BRANCH)

    def action_restart(self) -> None:
        """Close the dialog with the result `RESTART`, if a restart is offered."""
        if self._restart:
            self.dismiss(RESTART)


class LeaveQuestion(Dialog[bool]):
    """The dialog that asks whether to quit during a run; it returns True if the user wants to quit."""

    TITLE_TEXT: str = "Quit?"
    HINT: str = "y quits · n stays"
    BINDINGS: ClassVar[list[BindingType]] = [
        ("y,q,enter", "yes", "Quit"),
        ("n", "leave", "Stay"),
    ]

    def compose_content(self) -> ComposeResult:
        yield Static("A program is running. Everything logged so far is stored.", markup=False)
        yield from _compose_answers([("yes", "y", "Stop it and quit"), ("leave", "n", "Stay")])

    def action_yes(self) -> None:
        self.dismiss(True)


_LAST_WORD = re.compile(r"`[^`]+$|[^\W\d]\w*$")

_LOW = 30
"""In a terminal with fewer rows, the dialog is brief if the user needs to see what is below it."""

Form = tuple[str, str]
"""A form in which the user may type the text, such as an example, and what it means."""


class LineInput(Input):
    """A text field in which tab accepts the suggested completion; without a suggestion, tab goes to the next widget.

    Args:
        value: Initial text.
        words: Possible completions.
        placeholder: Text of the empty field.
    """

    BINDINGS: ClassVar[list[BindingType]] = [("tab", "accept", "Accept the completion")]

    def __init__(self, value: str, words: Sequence[str], placeholder: str) -> None:
        super().__init__(value, placeholder, compact=True, select_on_focus=False)
        self._words = words

    def action_accept(self) -> None:
        if complete_line(self.value, self._words) is None:
            self.screen.focus_next()
        else:
            self.action_cursor_right()

    @on(Input.Changed)
    def _complete(self, event: Input.Changed) -> None:
        # The completion is found synchronously: Textual's own suggester leaves a task behind, with a warning, when the
        # field closes first.
        if (completion := complete_line(event.value, self._words)) is not None:
            self.post_message(SuggestionReady(event.value, completion))


def complete_line(line: str, words: Sequence[str]) -> str | None:
    """Return a line with its last word completed; None if there is no completion.

    Args:
        line: The typed text.
        words: Possible completions; the first that begins with the line's last word is used.
    """
    match = _LAST_WORD.search(line)
    if match is None:
        return None
    typed = match[0]
    begun = (
        word for word in words if word.lower().startswith(typed.lower()) and len(word) > len(typed)
    )
    word = next(begun, None)
    # The typed text stays: a completion only appends to it.
    return None if word is None else line + word[len(typed) :]


def build_form_table(forms: Sequence[Form]) -> Static:
    """Return a table of the forms that a line of text may have, and what each means."""
    table = Table.grid(padding=(0, 2))
    for form, meaning in forms:
        table.add_row(form, meaning)
    return Static(table)


class LinePrompt(Dialog[bool]):
    """The dialog that asks for a line of text; it returns True after the line was applied.

    Args:
        title: Title of the dialog.
        do: Applies the line; a TuisimError is shown and the line can be corrected.
        value: Initial text, selected, so that typing replaces it.
        forms: The accepted forms.
        words: Possible completions of the current word; tab accepts one.
        placeholder: Text of the empty field.
        text: Text above the field; empty for none.
        sees_below: Whether the screen below should stay visible. In a low terminal, the dialog then lists the forms
            without explaining them.
    """

    HINT = "Enter applies · Escape closes"

    def __init__(
        self,
        title: str,
        do: Callable[[str], None],
        value: str = "",
        forms: Sequence[Form] = (),
        words: Sequence[str] = (),
        placeholder: str = "",
        text: str = "",
        *,
        sees_below: bool = False,
    ) -> None:
        super().__init__()
        self._text = text
        self._sees_below = sees_below
        self._placeholder = placeholder
        self._words = words
        self.TITLE_TEXT = escape_markup(title)
        self._do = do
        self._value = value
        self._forms = forms

    def compose_content(self) -> ComposeResult:
        if self._text:
            yield Static(self._text, markup=False, classes="start")
        yield LineInput(self._value, self._words, self._placeholder)
        yield Static(id="message", classes="wrong", markup=False)
        is_brief = self._sees_below and self.app.size.height < _LOW
        self.set_class(is_brief, "-brief")
        if is_brief:
            yield Static(" · ".join(form for form, _ in self._forms), id="forms", markup=False)
        else:
            yield build_form_table(self._forms)

    def on_mount(self) -> None:
        # A notice would cover a dialog at the bottom.
        self.app.clear_notifications()
        self.query_one(Input).action_select_all()

    @on(Input.Submitted)
    def _apply_line(self, event: Input.Submitted) -> None:
        event.stop()
        try:
            self._do(event.value.strip())
        except TuisimError as error:
            self.say(str(error), wrong=True)
            # The message takes the place of the forms, so that the dialog covers no more than before.
            self.query("#forms").remove()
            # With the text selected, the next letter replaces the line; an arrow key keeps it to be corrected.
            event.input.action_select_all()
            return
        self.dismiss(True)


class AnswerPrompt(LinePrompt):
    """The dialog for the answer to a lesson's question; it is at the top, so that the readings below stay visible."""
