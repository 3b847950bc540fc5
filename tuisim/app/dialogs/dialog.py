"""Base of the dialogs: a frame with a title, a single result, and Escape to close."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import partial
from typing import ClassVar, Generic, TypeVar

from rich.table import Table
from rich.text import Text
from textual.app import ComposeResult
from textual.await_complete import AwaitComplete
from textual.binding import Binding, BindingType
from textual.color import Color
from textual.containers import Vertical
from textual.events import Click, Event, Key
from textual.geometry import Region
from textual.keys import key_to_character
from textual.message import Message
from textual.renderables.background_screen import BackgroundScreen
from textual.strip import Strip
from textual.widgets import Input, OptionList, Static

from tuisim.app import background
from tuisim.app.action import KeyFooter, KeyWord, label_of_key, list_bindings, press
from tuisim.app.background import Made
from tuisim.base.errors import TuisimError
from tuisim.terminal.cell_view import JoinedStrip, LazyStrip
from tuisim.terminal.textual_internals import HookedScreen, find_bindings

Result = TypeVar("Result")

_HEIGHTS = [(0, "-low"), (18, "-high"), (34, "-roomy")]
"""CSS classes of a dialog, each with the number of rows of the terminal from which on it applies."""

WIDTHS = [(0, "-narrow"), (80, "-broad")]
"""CSS classes of dialogs with a picture, by the columns of the terminal: beside the list, or below it if narrow."""

_ENTER = re.compile(r"\bEnter\b(?: (\w+))?")
_IMPERATIVES = {"applies": "apply", "goes": "go"}


def name_and_title(name: str, title: str, name_cells: int, wraps: bool = True) -> Table:
    """Return an entry of a list as a table: a name in `name_cells` cells, and a title beside it.

    Args:
        name: The name.
        title: The title.
        name_cells: Width of the name.
        wraps: Whether a long title continues in further rows; else it is cut off.
    """
    table = Table.grid(padding=(0, 2), expand=True)
    table.add_column(width=name_cells, style="bold", no_wrap=not wraps)
    table.add_column(ratio=1, no_wrap=not wraps)
    # A user-defined name may contain brackets, which must not be read as markup.
    table.add_row(Text(name), Text(title))
    return table


MOVE_KEYS = [
    (key, f"move('{action}')")
    for key, action in (
        ("down", "cursor_down"),
        ("up", "cursor_up"),
        ("pagedown", "page_down"),
        ("pageup", "page_up"),
    )
]
"""Bindings of the keys that move the selection of a list even while a text field has the focus."""

_BETWEEN = " · "
_HINT_EDGES = 6
"""Cells of a dialog's lower border that hints in it cannot have."""
_TRANSPARENT = Color(0, 0, 0, 0)


def _strip_links(strip: Strip) -> Strip:
    """Return a row of the screen below a dialog without its links, because nothing there can be clicked."""
    if isinstance(strip, LazyStrip):
        return strip
    return Strip(BackgroundScreen.process_segments(strip, _TRANSPARENT), strip.cell_length)


def _shorten_label(key: str) -> str:
    return label_of_key(key).replace("ctrl+", "^").replace("escape", "esc")


def _find_enter_verb(hint: str) -> str:
    """Return the verb for what Enter does, such as `open` if the hint in a dialog's frame says that Enter opens a file.

    The result is empty if the hint does not name Enter.
    """
    match = _ENTER.search(hint)
    if match is None:
        return ""
    verb = match[1] or "chooses"
    return _IMPERATIVES.get(verb, verb.removesuffix("s"))


class ClosesOnce(HookedScreen[Result], Generic[Result]):
    """A modal screen that returns one result, and ignores all events after it has returned the result.

    Textual's `dismiss` removes the topmost screen, whichever screen it was called for: without this class, a key
    pressed twice would return two results, and remove the screen below as well.
    """

    # The app's keys do not work below a modal screen.
    BINDINGS: ClassVar[list[BindingType]] = [
        ("ctrl+z", "app.suspend_process", "Suspend"),
        ("ctrl+l", "app.redraw", "Redraw"),
        ("f12", "app.save_screen", "Screenshot"),
    ]

    class Changed(Message):
        """Posted when the screen has become ready for keys, or has closed."""

    is_ready = False
    """Whether the screen is mounted, and has focused the widget that gets the first key."""
    _is_at_work = False
    """Whether a function runs in a thread, so that keys have to wait for its result."""

    def on_mount(self) -> None:
        self.call_after_refresh(self.app.call_later, self._mark_ready)

    def _mark_ready(self) -> None:
        self.is_ready = True
        self.app.post_message(self.Changed())

    def can_take(self, event: Event) -> bool:
        """Return whether the screen can handle an event now; if not, this event and all later events wait."""
        return self.is_ready and not (
            self._is_at_work and isinstance(event, Key) and event.key != "escape"
        )

    def wait_while(
        self,
        work: Callable[[], Made],
        then: Callable[[Made], None],
        failed: Callable[[TuisimError], None],
    ) -> None:
        """Run a function in a thread; meanwhile keys wait, except for Escape.

        Args:
            work: Called in the thread.
            then: Called with the result.
            failed: Called with a TuisimError that `work` has raised.
        """
        self._is_at_work = True
        background.run(
            self, work, partial(self._finish_work, then), partial(self._finish_work, failed)
        )

    def _finish_work(self, then: Callable[[Made], None], result: Made) -> None:
        self._is_at_work = False
        then(result)
        self.app.post_message(self.Changed())

    @property
    def is_closed(self) -> bool:
        """Whether the screen has returned its result, or was never opened."""
        return self not in self.app.screen_stack

    def dismiss(self, result: Result | None = None) -> AwaitComplete:
        """Close the screen with a result, and every screen above it with None; do nothing if it is closed already."""
        if self.is_closed:
            return AwaitComplete()
        stack = self.app.screen_stack
        opened = stack[stack.index(self) :]
        for screen in opened:
            if not screen.is_mounted:
                # Textual cannot remove a screen that it is still mounting.
                screen.call_later(self._dismiss_later, result)
                return AwaitComplete()
        for above in reversed(opened[1:]):
            above.dismiss(None)
        self.app.post_message(self.Changed())
        return super().dismiss(result)

    def _dismiss_later(self, result: Result | None) -> None:
        # Textual refuses to wait for the removal of a screen in a message of that screen.
        self.dismiss(result)

    def render_lines(self, crop: Region) -> list[Strip]:
        """Return the rows of the dialog's background, in which the screen below the dialog is visible.

        Pictures on that screen keep their pixels; Textual's own method would return them as plain text.
        """
        below = None if self.styles.background.a else self.read_lower_parts(crop)
        if below is None:
            return super().render_lines(crop)
        rows = (JoinedStrip([_strip_links(part) for part in parts]) for parts in below)
        return [row.crop_extend(*crop.column_span, self.rich_style) for row in rows]

    def should_drop(self, message: Message) -> bool:
        """Return whether to ignore a message, because the screen is closed.

        Widgets of a closed screen may still post messages, for example for a second Enter.
        """
        return message.bubble and self.is_closed


class Dialog(ClosesOnce[Result], Generic[Result]):
    """A modal screen with a titled frame around its widgets; Escape closes it with the result None."""

    TITLE_TEXT: str = ""
    HINT: str = "Escape closes"
    VERTICAL_BREAKPOINTS: list[tuple[int, str]] | None = _HEIGHTS
    BINDINGS: ClassVar[list[BindingType]] = [("escape", "leave", "Close")]

    def compose(self) -> ComposeResult:
        # Textual would set this class only after it has drawn the dialog once.
        self.add_class(max(height for height in _HEIGHTS if height[0] <= self.app.size.height)[1])
        frame = Vertical(classes="dialog")
        frame.border_title = self.TITLE_TEXT
        frame.border_subtitle = self.HINT
        with frame:
            yield from self.compose_content()

    def on_resize(self) -> None:
        """Show as many hints as fit in the frame; if not all fit, the hints just before the last one are left out."""
        frame = self.query_one(".dialog")
        hints = self.HINT.split(_BETWEEN)
        while len(_BETWEEN.join(hints)) > frame.region.width - _HINT_EDGES and len(hints) > 2:
            del hints[-2]
        frame.border_subtitle = _BETWEEN.join(hints)

    @property
    def keys(self) -> tuple[KeyWord, ...]:
        """The keys for the footer: Enter, the dialog's own keys that work with the present focus, then Escape."""
        words = (
            (binding.key.split(","), binding.description.lower())
            for binding in self._collect_bindings()
            if binding.description
        )
        working = (
            (next((key for key in keys if self._receives_key(key)), ""), word)
            for keys, word in words
        )
        own = tuple((_shorten_label(key), word) for key, word in working if key)
        enter = _find_enter_verb(self.HINT)
        return own if not enter or "enter" in dict(own) else (("enter", enter), *own)

    def _collect_bindings(self) -> list[Binding]:
        kinds = [kind for kind in type(self).__mro__ if issubclass(kind, Dialog)]
        return [binding for kind in kinds for binding in list_bindings(kind)]

    async def on_click(self, event: Click) -> None:
        """Press a key of the dialog if the user has clicked the key's word in the footer below the dialog.

        With a click, the user of a phone can press keys that the phone's keyboard lacks, such as Escape.
        """
        keys = {
            _shorten_label(key): key
            for binding in self._collect_bindings()
            for key in binding.key.split(",")
        } | {"enter": "enter"}
        footers = (
            footer for screen in self.app.screen_stack[:-1] for footer in screen.query(KeyFooter)
        )
        for footer in footers:
            if footer.region.contains(event.screen_x, event.screen_y):
                label = footer.find_dialog_key(event.screen_x - footer.region.x)
                await press(self, keys.get(label, ""))

    def _receives_key(self, key: str) -> bool:
        """Return whether a key reaches the dialog: a focused text field takes letters and some other keys itself."""
        field = self.focused
        if not isinstance(field, Input):
            return True
        return (
            not field.check_consume_key(key, key_to_character(key))
            and key not in find_bindings(field).key_to_bindings
        )

    def compose_content(self) -> ComposeResult:
        """Yield the widgets inside the dialog's frame."""
        yield from ()

    def say(self, text: str, wrong: bool = False) -> None:
        """Show a text in the dialog's message line; `wrong` marks it as an error."""
        message = self.query_one("#message", Static)
        message.update(text)
        message.set_class(wrong, "wrong")

    def action_leave(self) -> None:
        self.dismiss(None)

    def action_move(self, action: str) -> None:
        """Run an action of the dialog's list, such as `cursor_down`, see `MOVE_KEYS`."""
        getattr(self.query_one(OptionList), f"action_{action}")()


class FieldDialog(Dialog[Result], Generic[Result]):
    """A dialog with a list and a field: what the user types while the list has the focus goes into the field."""

    def on_key(self, event: Key) -> None:
        typed = (event.character or "").strip() if event.is_printable else ""
        for field in self.query(Input):
            if not field.has_focus and (typed or event.key == "backspace"):
                event.stop()
                field.focus()
                field.insert_text_at_cursor(typed) if typed else field.action_delete_left()
