"""Parts of forms: rows with a label, a field and an error line; choices, number fields, sliders."""

from __future__ import annotations

from typing import ClassVar

from rich.style import Style
from rich.text import Text
from textual import events, on
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.containers import Horizontal, Vertical
from textual.message import Message
from textual.reactive import reactive
from textual.widget import Widget
from textual.widgets import Input, Label, Static
from textual.widgets.input import Selection

from tuisim.app.action import ActionHost, KeyWord
from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError, TuisimError


def format_error(error: TuisimError) -> str:
    """Return the message of an error without its location, which the form's field already shows."""
    message = error.message
    if isinstance(error, ConfigError) and error.key and not error.file:
        message = message.removeprefix(f"{error.key}: ")
    return f"{message} ({error.hint})" if error.hint else message


def parse_number(text: str, error: type[ConfigError]) -> float:
    """Return the number that a typed text stands for; the decimal sign is a point or a comma.

    Raises:
        ConfigError: the text is no number; the error is of the class `error`.
    """
    try:
        return float(text.strip().replace(",", "."))
    except ValueError:
        raise error(f"must be a number, got {text.strip()[:20]!r}") from None


class _Control(Widget, can_focus=True):
    """Base of widgets that look different while they have the focus."""

    ALLOW_SELECT = False

    def on_focus(self) -> None:
        self.refresh()

    def on_blur(self) -> None:
        self.refresh()


class Choice(_Control):
    """A widget that shows one of several words; the user changes it with ← and →, or with a click."""

    DEFAULT_CSS = "Choice { height: 1; width: 1fr; }"
    BINDINGS: ClassVar[list[BindingType]] = [
        ("left", "step(-1)", "Before"),
        ("right,enter", "step(1)", "Next"),
    ]

    @dataclass
    class Stepped(Message):
        """Posted when the user asks for another of the words; `by` says how many words to go on."""

        choice: Choice
        by: int

    value = reactive("")
    """The word shown; setting it posts no message."""

    def action_step(self, by: int) -> None:
        self.post_message(self.Stepped(self, by))

    def on_click(self, event: events.Click) -> None:
        """Ask for the previous choice if the left end was clicked, else for the next choice."""
        event.stop()
        self.action_step(-1 if event.x == 0 else 1)

    def render(self) -> Text:
        line = Text(f"‹ {self.value}", no_wrap=True, end="")
        line.truncate(max(self.size.width - 2, 1), overflow="ellipsis")
        line.append(" ›")
        return line


class FormPanel(Vertical):
    """A panel with text fields, and a last line for errors."""

    USE: ClassVar[str] = ""
    """Help that the last line shows while there is no error."""

    def say(self, wrong: str) -> None:
        """Show an error in the last line; an empty text removes it."""
        self.query_one("#message", Static).update(wrong or self.USE)
        self.set_class(bool(wrong), "-wrong")

    @on(Input.Changed)
    def _take_back(self, event: Input.Changed) -> None:
        """Remove the error from the last line, because the user is correcting the wrong value."""
        event.stop()
        if self.has_class("-wrong"):
            event.input.remove_class("wrong")
            self.say("")


class EntryPanel(FormPanel):
    """A panel with text fields; the value of a field is applied on Enter, and when the field loses the focus."""

    @on(Input.Submitted)
    def _apply_submitted(self, event: Input.Submitted) -> None:
        event.stop()
        self._apply(event.input)

    def on_descendant_blur(self, event: events.DescendantBlur) -> None:
        if isinstance(event.widget, Input) and not event.widget.disabled:
            self._apply(event.widget)

    def _apply(self, entry: Input) -> None:
        """Apply the value of a field; if the value is invalid, show why."""


class Row(Vertical):
    """One row of a form: a label, and a text field or a choice of words.

    Args:
        field: Id of the field that the row edits.
        label: The label; if it is empty, the field has the whole width.
        chosen: Whether the row has a choice instead of a text field.
    """

    DEFAULT_CSS = """
    Row { height: auto; }
    Row > Horizontal { height: 1; }
    Row Input { width: 1fr; height: 1; }
    Row > .message { display: none; height: auto; }
    Row.-wrong > .message { display: block; }
    """

    @dataclass
    class Entered(Message):
        """Posted when the user has typed a value into the row, or has asked for another of its choices."""

        row: Row
        text: str
        """The text that the user typed."""
        by: int = 0
        """Number of choices to go forward in the list; negative to go back, 0 if the user has typed a text."""

    def __init__(self, field: str, label: str, chosen: bool) -> None:
        super().__init__()
        self.field = field
        self._label = label
        self.entry: Choice | Input = (
            Choice() if chosen else Input(compact=True, select_on_focus=True)
        )
        self._shown = ""

    def compose(self) -> ComposeResult:
        with Horizontal():
            if self._label:
                yield Label(self._label, markup=False)
            yield self.entry
        yield Static(classes="message", markup=False)

    def show(self, text: str) -> None:
        """Show a value in the row, unless the user is typing another one."""
        if text != self._shown or not self._typing:
            self._shown = self.entry.value = text
            self.show_error("")

    @property
    def _typing(self) -> bool:
        return self.entry.has_focus and self.entry.value != self._shown

    def show_error(self, text: str) -> None:
        """Show an error below the field; an empty text removes the error."""
        self.set_class(bool(text), "-wrong")
        self.entry.set_class(bool(text), "wrong")
        if self.is_mounted:
            self.query_one(".message", Static).update(text)

    def refuse(self, error: TuisimError) -> None:
        """Show below the field why the value that the user typed was rejected."""
        self.show_error(format_error(error))

    @on(Input.Submitted)
    def _enter_submitted(self, event: Input.Submitted) -> None:
        event.stop()
        self._enter()

    @on(Input.Changed)
    def _take_back(self, event: Input.Changed) -> None:
        event.stop()
        if self.has_class("-wrong"):
            self.show_error("")

    def on_descendant_focus(self) -> None:
        # A cursor at the end of the selection would scroll the beginning of a long value out of view.
        whole = Selection(0, len(self.entry.value))
        if isinstance(self.entry, Input) and self.entry.selection == whole:
            self.entry.selection = Selection(whole.end, whole.start)

    def on_descendant_blur(self) -> None:
        if isinstance(self.entry, Input) and self.entry.value != self._shown:
            self._enter()

    def _enter(self) -> None:
        self.post_message(self.Entered(self, self.entry.value))

    @on(Choice.Stepped)
    def _enter_step(self, event: Choice.Stepped) -> None:
        event.stop()
        self.post_message(self.Entered(self, self.entry.value, event.by))


class NumberInput(Input):
    """A text field for a number, which accepts no other characters."""

    def __init__(self, value: str = "", *, id: str) -> None:  # noqa: A002 (as every widget's)
        super().__init__(value, id=id, compact=True, select_on_focus=True, restrict=r"[-+0-9.,]*")

    def on_key(self, event: events.Key) -> None:
        """If a letter is pressed, which the field does not accept, show how to leave the field."""
        if event.character and event.character.isalpha() and isinstance(self.app, ActionHost):
            self.app.say("This field takes a number: escape leaves it, and letters are keys again")


STEP = 1
LONG_STEP = 10


class Slider(_Control):
    """One row with a bar and a knob, which sets a number from 0.

    Args:
        maximum: The number at the right end.
        id: Id of the widget.
    """

    DEFAULT_CSS = "Slider { height: 1; width: 1fr; min-width: 6; }"
    FOOTER_KEYS: ClassVar[tuple[KeyWord, ...]] = (("← →", "set"), ("0…9", "number"))
    COMPONENT_CLASSES: ClassVar[set[str]] = {"slider--filled", "slider--empty", "slider--knob"}
    BINDINGS: ClassVar[list[BindingType]] = [
        ("left", f"move({-STEP})", "Less"),
        ("right", f"move({STEP})", "More"),
        ("shift+left,pagedown,down", f"move({-LONG_STEP})", "Much less"),
        ("shift+right,pageup,up", f"move({LONG_STEP})", "Much more"),
        ("home", "put(0)", "None"),
        ("end", "put_last", "Most"),
    ]

    @dataclass
    class Changed(Message):
        """Posted when the user has set another number with the slider."""

        slider: Slider
        value: int
        done: bool = True
        """False while the mouse holds the knob or digits are typed; then the final number is posted again with True."""

        @property
        def control(self) -> Slider:
            """The slider that has changed, so that handlers can select it by its id."""
            return self.slider

    value = reactive(0)
    """The number; setting it posts no message."""

    def __init__(self, maximum: int, id: str) -> None:  # noqa: A002 (as every widget's)
        super().__init__(id=id)
        self.maximum = maximum
        self.dragging = False
        self._typed = ""
        """The digits of a number that is being typed."""

    def validate_value(self, value: int) -> int:
        """Return the number nearest to `value` that the slider can have."""
        return min(max(value, 0), self.maximum)

    def on_key(self, event: events.Key) -> None:
        """Set the number to the digits that the user types one after another; any other key ends the number."""
        if event.character and event.character.isdecimal() and event.character.isascii():
            event.stop()
            event.prevent_default()
            longer = int(f"{self._typed}{event.character}")
            self._typed = str(longer if longer <= self.maximum else int(event.character))
            self._choose(int(self._typed), done=False)
        else:
            self._end_typing()

    def on_blur(self) -> None:
        self._end_typing()

    def _end_typing(self) -> None:
        if self._typed:
            self._typed = ""
            self.post_message(self.Changed(self, self.value))

    def _choose(self, value: int, *, done: bool = True) -> None:
        before = self.value
        self.value = value
        if self.value != before:
            self.post_message(self.Changed(self, self.value, done and not self.dragging))

    def action_move(self, step: int) -> None:
        self._choose(self.value + step)

    def action_put(self, value: int) -> None:
        self._choose(value)

    def action_put_last(self) -> None:
        self._choose(self.maximum)

    def _find_knob_column(self) -> int:
        return round(self.value / self.maximum * (self.size.width - 1))

    def _find_value(self, event: events.MouseEvent) -> int:
        last = max(self.size.width - 1, 1)
        return round(min(max(event.x, 0), last) / last * self.maximum)

    def on_mouse_down(self, event: events.MouseDown) -> None:
        if event.button == 1:
            event.stop()
            self.focus()
            self.dragging = True
            self.capture_mouse()
            if event.x != self._find_knob_column():
                self._choose(self._find_value(event))

    def on_mouse_move(self, event: events.MouseMove) -> None:
        if self.dragging:
            event.stop()
            self._choose(self._find_value(event))

    def on_mouse_up(self, event: events.MouseUp) -> None:
        if self.dragging:
            event.stop()
            self._let_go()
            self.release_mouse()

    def on_mouse_release(self) -> None:
        """Release the knob, because a dialog has captured the mouse."""
        if self.dragging:
            self._let_go()

    def _let_go(self) -> None:
        self.dragging = False
        self.post_message(self.Changed(self, self.value))

    def on_mouse_scroll_up(self, event: events.MouseScrollUp) -> None:
        event.stop()
        self._choose(self.value + STEP)

    def on_mouse_scroll_down(self, event: events.MouseScrollDown) -> None:
        event.stop()
        self._choose(self.value - STEP)

    def render(self) -> Text:
        knob = self._find_knob_column()
        width = self.size.width
        filled, empty, knob_style = (
            self.get_component_rich_style(f"slider--{part}", partial=True)
            for part in ("filled", "empty", "knob")
        )
        # A different glyph shows the focus, so that it is visible without colours too.
        mark = Text("◆" if self.has_focus else "●", knob_style + Style(bold=True))
        return Text.assemble(
            ("━" * knob, filled), mark, ("─" * (width - knob - 1), empty), no_wrap=True, end=""
        )
