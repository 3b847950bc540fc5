"""Textual's private names: all that this project uses, and whether the Textual that is installed has them.

Why, and what breaks when Textual changes: `tuisim guide architecture`. Without `SUPPORTED` everything here does what
Textual does by itself.
"""

from __future__ import annotations

import os
import re
from abc import abstractmethod
from collections.abc import Awaitable, Callable, Mapping, Sequence
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any, Generic, Literal, TextIO, TypeVar, cast

import textual
from rich.console import Console, ConsoleRenderable, RichCast
from rich.segment import Segment
from textual import keys as textual_keys
from textual import screen as textual_screen
from textual.app import App
from textual.binding import BindingsMap
from textual.dom import DOMNode
from textual.driver import Driver
from textual.drivers import linux_driver
from textual.drivers.linux_driver import LinuxDriver
from textual.events import Click
from textual.filter import LineFilter
from textual.geometry import Region, Size
from textual.message import Message
from textual.message_pump import MessagePump
from textual.screen import ModalScreen, Screen
from textual.selection import Selection
from textual.strip import Strip
from textual.widget import Widget
from textual.widgets import OptionList, TextArea

if TYPE_CHECKING:
    from textual._callback import invoke as invoke
    from textual._compositor import ChopsUpdate as ChopsUpdate
    from textual._compositor import Compositor, CompositorMap, ReflowResult
    from textual._compositor import CompositorUpdate as CompositorUpdate
    from textual._compositor import LayoutUpdate as LayoutUpdate
    from textual._context import visible_screen_stack
    from textual._styles_cache import StylesCache
    from textual._xterm_parser import XTermParser as XTermParser
    from textual.document._wrapped_document import WrappedDocument
else:
    try:
        from textual._callback import invoke
        from textual._compositor import (
            ChopsUpdate,
            Compositor,
            CompositorUpdate,
            LayoutUpdate,
            ReflowResult,
        )
        from textual._context import visible_screen_stack
        from textual._styles_cache import StylesCache
        from textual._xterm_parser import XTermParser
        from textual.document._wrapped_document import WrappedDocument
    except ImportError:
        invoke = visible_screen_stack = None
        Compositor = ReflowResult = StylesCache = WrappedDocument = XTermParser = object
        CompositorUpdate = ChopsUpdate = LayoutUpdate = type("NoUpdate", (), {})

Result = TypeVar("Result")

Version = tuple[int, ...]
TESTED: tuple[Version, Version] = (8, 2, 5), (8, 2, 8)
"""The first and the last version of Textual that the kit was tried with."""

_METADATA = re.compile(r"textual-([\d.]+)\.dist-info")

_USED: Mapping[type, tuple[str, ...]] = {
    App: (
        "_background_screens",
        "_batch_count",
        "_closed",
        "_display",
        "_driver",
        "_exit",
        "_filters",
        "_handle_exception",
        "_running",
        "_shutdown",
    ),
    Compositor: ("_dirty_regions", "_full_map", "_render_chops", "reflow", "render_strips"),
    DOMNode: ("_bindings",),
    LinuxDriver: (
        "_app",
        "_auto_restart",
        "_file",
        "_loop",
        "_must_signal_resume",
        "_sigcont_application",
        "_writer_thread",
    ),
    MessagePump: ("_dispatch_message", "_on_message"),
    OptionList: ("_move_page", "_on_click"),
    Screen: ("_compositor",),
    Strip: ("_cell_count", "_cell_length", "_link_ids", "_render_cache", "_segments"),
    StylesCache: ("get_inner_outer",),
    TextArea: ("_find_columns_to_next_tab_stop",),
    Widget: ("_component_styles", "_message_loop_exit"),
    WrappedDocument: ("_offset_to_line_info",),
    XTermParser: ("feed", "tick"),
}
"""The names by class: methods, and attributes that its `__init__` sets."""
_GLOBALS: Sequence[tuple[ModuleType, str]] = (
    (linux_driver, "XTermParser"),
    (linux_driver, "getincrementaldecoder"),
    (textual_keys, "_character_to_key"),
)
"""Private names in Textual's modules."""


def list_missing_names() -> list[str]:
    """Return the names that this module uses and the installed Textual lacks, such as `App._display`."""
    missing = [
        f"{owner.__name__}.{name}"
        for owner, names in _USED.items()
        for name in names
        if not _has(owner, name)
    ]
    # Short names, as the message lists all that are missing.
    lacking = [
        f"{module.__name__.rpartition('.')[2]}.{name}"
        for module, name in _GLOBALS
        if not hasattr(module, name)
    ]
    return [*missing, *lacking]


def _has(owner: type, name: str) -> bool:
    codes = (getattr(vars(base).get("__init__"), "__code__", None) for base in owner.__mro__)
    return hasattr(owner, name) or any(code is not None and name in code.co_names for code in codes)


def read_textual_version() -> Version:
    """Return the version of the installed Textual; empty if it is no release.

    The version is read from the name of the folder with the package's metadata, `textual-1.2.3.dist-info`: the function
    of `importlib.metadata` would take a tenth of the time in which Textual is imported.
    """
    numbers = [
        _METADATA.fullmatch(entry.name) for entry in os.scandir(Path(textual.__file__).parents[1])
    ]
    return next((tuple(map(int, match[1].split("."))) for match in numbers if match), ())


def describe_textual() -> tuple[Version, tuple[Version, Version], list[str]]:
    """Return the installed version of Textual, the first and last tested versions, and the names that are missing.

    The missing names are those that this module uses and the installed version lacks.
    """
    return read_textual_version(), TESTED, list_missing_names()


def _is_tested() -> bool:
    version, (first, last), missing = describe_textual()
    return first <= version <= last and not missing


SUPPORTED = _is_tested()
"""Whether Textual's private names may be used. Without them the app draws half blocks, through Textual's own driver."""


class HookedApp(App[None]):
    """Textual's app with methods that subclasses override: for drawing, for errors, and for the shutdown."""

    def show_update(self, screen: Screen[Any], update: object) -> None:
        """Draw an update of a screen; a subclass may draw something else instead."""
        super()._display(screen, cast(ConsoleRenderable | RichCast | str | None, update))

    def _display(
        self, screen: Screen[Any], renderable: ConsoleRenderable | RichCast | str | None
    ) -> None:
        self.show_update(screen, renderable)

    def is_harmless(self, error: Exception) -> bool:
        """Return whether an unhandled error can be ignored; in this class, none can."""
        return False

    def _handle_exception(self, error: Exception) -> None:
        if not self.is_harmless(error):
            super()._handle_exception(error)

    async def _shutdown(self) -> None:
        # The app may be shut down without `exit`: it is leaving, too.
        self._exit = True
        await super()._shutdown()

    @property
    def own_driver(self) -> Driver | None:
        """The driver that draws the app; None before the app has started."""
        return self._driver

    @property
    def is_writing(self) -> bool:
        """Whether Textual sends what it draws to a terminal now.

        False in a batch of updates, for an app without a terminal, and before and after the app runs.
        """
        if not SUPPORTED:
            return False
        return self._running and not (
            self._closed or self._batch_count or self.is_headless or self._driver is None
        )

    @property
    def line_filters(self) -> list[LineFilter]:
        """The filters, in the order in which they are applied to everything that is drawn; also disabled filters."""
        return self._filters if SUPPORTED else []

    @line_filters.setter
    def line_filters(self, filters: Sequence[LineFilter]) -> None:
        if SUPPORTED:
            self._filters = [*filters]


class HookedScreen(ModalScreen[Result], Generic[Result]):
    """Textual's modal screen; it can also ignore messages, and read what the screen below draws."""

    def should_drop(self, message: Message) -> bool:
        """Return whether to ignore a message; in this class, none is ignored."""
        return False

    async def _on_message(self, message: Message) -> None:
        if not self.should_drop(message):
            await super()._on_message(message)

    def read_lower_parts(self, crop: Region) -> list[list[Strip]] | None:
        """Return the drawn strips of the screen below this one, a list from left to right for each row of a region.

        The result is None if there is no such screen, or if the installed Textual is not supported.

        Args:
            crop: The region, of which only the rows matter.
        """
        stack = self.app.screen_stack
        index = stack.index(self) if self in stack else 0
        if not index or not SUPPORTED:
            return None
        rows = Region(0, crop.y, self.size.width, crop.height)
        chops = stack[index - 1]._compositor._render_chops(rows, rows.line_range.__contains__)
        below = [[part for part in chop.values() if part] for chop in chops[crop.y : crop.bottom]]
        # After a resize, the screen below may still be laid out for fewer rows.
        return below + [[] for _ in range(crop.height - len(below))]


class Codes(CompositorUpdate):
    """An update of the screen that consists of codes for the terminal."""

    def __init__(self, codes: str) -> None:
        self._codes = codes

    def render_segments(self, console: Console) -> str:
        """Return the codes unchanged."""
        return self._codes


class MadeOnDemand(Strip):
    """A strip whose segments are made when they are read for the first time."""

    __slots__ = ["_made"]

    # The base class's caches are omitted: every method that uses one is overridden by the subclasses.
    def begin(self, cells: int) -> None:
        """Set the width in cells; subclasses call this in their `__init__`, in place of `Strip.__init__`."""
        if not SUPPORTED:
            super().__init__(self.make(), cells)
            return
        self._made: list[Segment] | None = None
        self._cell_length = self._cell_count = cells
        self._link_ids = set()
        self._render_cache = None

    @abstractmethod
    def make(self) -> list[Segment]:
        """Return the segments of the strip."""

    if SUPPORTED:

        @property
        def _segments(self) -> list[Segment]:  # type: ignore[override]  # a slot of the base class
            if self._made is None:
                self._made = self.make()
            return self._made


class HookedLinuxDriver(LinuxDriver):
    """Textual's driver of a terminal, with a method for subclasses that is called when a stopped process continues."""

    def handle_continuation(self) -> None:
        """Handle that the stopped process continues; called from the handler of the signal."""
        super()._sigcont_application()

    def _sigcont_application(self, *_: object) -> None:
        self.handle_continuation()

    def wrap_output(self, wrap: Callable[[TextIO], object]) -> None:
        """Replace the driver's output file by an object around it.

        Args:
            wrap: Returns the object for the present output file; the object needs `write`, `flush` and `fileno`.
        """
        self._file = wrap(cast(TextIO, self._file))  # type: ignore[assignment]  # write, flush and fileno are enough

    @property
    def resumes(self) -> bool:
        """Whether the driver takes the terminal back when the process is continued."""
        return self._auto_restart and not self._loop.is_closed()

    @property
    def writes(self) -> bool:
        """Whether the driver's thread that writes to the terminal is alive."""
        return self._writer_thread is not None and self._writer_thread.is_alive()

    def call_soon(self, function: Callable[[], None]) -> None:
        """Call a function in the app's event loop; this may be called from any thread or signal handler."""
        self._loop.call_soon_threadsafe(function)

    def resume(self) -> None:
        """Take the terminal back, and tell the app that it has been resumed."""
        self._must_signal_resume = True
        self.resume_application_mode()


class ThoroughCompositor(Compositor):
    """Textual's compositor, changed to compare each layout with the last one for which the widgets were sent messages.

    Textual compares a layout with its newest map of all widgets. It makes a new map whenever code asks for the size of
    a widget between two layouts. A widget that was mounted before this request is then in both maps, and is never sent
    `Resize` or `Show`; a widget that was removed stays on the screen. Whether code asks between two layouts depends on
    how busy the machine is.
    """

    def __init__(self) -> None:
        super().__init__()
        self._told: CompositorMap = {}

    def reflow(self, parent: Widget, size: Size) -> ReflowResult:
        """Lay out the widgets below `parent`.

        Returns:
            Which widgets were hidden, shown or resized since the last call of this method.
        """
        before = self._full_map
        hidden, visible, resized = super().reflow(parent, size)
        previous_map = self._told
        self._told = self._full_map
        if before is not previous_map:
            visible = visible | (self._told.keys() - previous_map.keys())
            resized = resized | {
                widget
                for widget in self._told.keys() & previous_map.keys()
                if self._told[widget].region.size != previous_map[widget].region.size
            }
            changes = (geometry for _, geometry in self._told.items() ^ previous_map.items())
            self._dirty_regions.update(
                filter(None, (change.clip.intersection(change.region) for change in changes))
            )
        return ReflowResult(hidden, visible, resized)


def is_leaving(app: App[Any]) -> bool:
    """Return whether the app is shutting down, so that nothing can be opened any more."""
    return bool(getattr(app, "_exit", False))


NOTICE_LAYER = "_toastrack"
"""The layer above all others of an app that shows notices."""


def can_show_notices(app: App[Any]) -> bool:
    """Return whether an app can show notices; they may be disabled in an app without a terminal."""
    return not getattr(app, "_disable_notifications", False)


def find_app(driver: Driver) -> App[Any]:
    """Return the app to which a driver belongs."""
    return driver._app


def replace_write(driver: Driver, write: Callable[[bytes], int]) -> None:
    """Let the driver of a browser call a function in place of its own `write`."""
    driver._write = write  # type: ignore[attr-defined]  # a partial function


def find_bindings(node: DOMNode) -> BindingsMap:
    """Return the bindings of keys of a node; the caller may change them."""
    return getattr(node, "_bindings", None) or BindingsMap()


def render_screen(app: App[Any]) -> list[Strip]:
    """Return all rows of an app's screen, with its dialogs and notices."""
    if SUPPORTED:
        # Textual's own `export_screenshot` sets this variable, too.
        visible_screen_stack.set(app._background_screens)
    return app.screen._compositor.render_strips()


def find_selection(widget: Widget) -> Selection | None:
    """Return the selected part of a widget's text; None if its screen is not drawn yet, or is gone."""
    screen = widget.screen
    return (
        screen.selections.get(widget) if "screen--selection" in screen._component_styles else None
    )


def find_key(character: str) -> str:
    """Return the name of the key that types a character, such as `question_mark`; the character itself if unknown."""
    name_of = getattr(textual_keys, "_character_to_key", str)
    return str(name_of(character))


def count_tab_columns(area: TextArea) -> int:
    """Return the number of columns from the cursor of a text to the next tab stop."""
    return area._find_columns_to_next_tab_stop() if SUPPORTED else area.indent_width


def find_line(area: TextArea, row: int) -> tuple[int, int]:
    """Return the line of a text area that a row shows, and which row of that wrapped line it is, both from 0.

    Raises:
        IndexError: there is no such row.
    """
    if not SUPPORTED:
        raise IndexError(row)
    return area.wrapped_document._offset_to_line_info[row]


Post = Callable[[MessagePump, Message], bool]
Dispatch = Callable[[MessagePump, Message], Awaitable[None]]
CallNext = Callable[..., None]
CallLater = Callable[..., bool]

POST: Post = MessagePump.post_message
DISPATCH: Dispatch = MessagePump._dispatch_message if SUPPORTED else cast(Dispatch, None)
CALL_NEXT: CallNext = MessagePump.call_next
CALL_LATER: CallLater = MessagePump.call_after_refresh
END: Callable[[Widget], Awaitable[None]] = (
    Widget._message_loop_exit if SUPPORTED else cast(Any, None)
)
"""Textual's own functions for messages; two of them only if it is supported."""


def route_messages(
    post: Post, dispatch: Dispatch, call_next: CallNext, call_later: CallLater
) -> None:
    """Make every widget handle messages and callbacks with these functions instead of Textual's own.

    Args:
        post, dispatch: Replace `post_message` and `_dispatch_message` of `MessagePump`.
        call_next, call_later: Replace `call_next` and `call_after_refresh` of `MessagePump`.
    """
    MessagePump.post_message = post  # type: ignore[method-assign, assignment]
    MessagePump._dispatch_message = dispatch  # type: ignore[method-assign, assignment]
    MessagePump.call_next = call_next  # type: ignore[method-assign]
    MessagePump.call_after_refresh = call_later  # type: ignore[method-assign]


def set_input_parser(parser: type[XTermParser], decoder: Callable[[], Any]) -> None:
    """Let Textual's driver of a terminal parse its input with another class, and decode it with another decoder.

    Args:
        parser: The class of the parser.
        decoder: Called without arguments for a new decoder of bytes.
    """
    if SUPPORTED:
        linux_driver.XTermParser = parser  # type: ignore[attr-defined]
        linux_driver.getincrementaldecoder = lambda _: decoder  # type: ignore[attr-defined, assignment]


def set_page_parser(parser: type[XTermParser]) -> None:
    """Let Textual's driver for browsers use a parser of this class."""
    # This is imported on demand, since most apps run in a terminal.
    from textual.drivers import web_driver

    web_driver.XTermParser = parser  # type: ignore[attr-defined]


_click, _move_page = getattr(OptionList, "_on_click", None), getattr(OptionList, "_move_page", None)


async def _choose_clicked(listed: OptionList, event: Click) -> None:
    """Select the clicked option of a list; do nothing if the list no longer has that option."""
    if event.style.meta.get("option", 0) < listed.option_count:
        await _click(listed, event)  # type: ignore[misc]  # there if it is called


def _move_seen_page(listed: OptionList, direction: Literal[-1, 1]) -> None:
    """Move the highlight of a list by as many rows as are visible; do nothing if none is."""
    if listed.scrollable_content_region:
        _move_page(listed, direction)  # type: ignore[misc]  # there if it is called


def repair_textual(end_messages: Callable[[Widget], Awaitable[None]]) -> None:
    """Replace functions of Textual's screens and lists that have errors.

    Args:
        end_messages: Called in place of Textual's function after the last message of a widget.
    """
    if not SUPPORTED:
        return
    # A screen makes its compositor itself, so the class is replaced.
    textual_screen.Compositor = ThoroughCompositor  # type: ignore[attr-defined]
    OptionList._on_click = _choose_clicked  # type: ignore[method-assign, assignment]
    OptionList._move_page = _move_seen_page  # type: ignore[method-assign, assignment]
    Widget.text_selection = property(find_selection)  # type: ignore[assignment]
    Widget._message_loop_exit = end_messages  # type: ignore[method-assign, assignment]
    # Otherwise the cache of this method keeps its object, and thereby the rows of a thousand widgets that are gone.
    StylesCache.get_inner_outer = classmethod(StylesCache.get_inner_outer)  # type: ignore[method-assign, arg-type, assignment]
