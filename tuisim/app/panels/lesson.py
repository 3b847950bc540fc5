"""The lesson panel: the step to do, its result, and hints."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from textual.binding import BindingType

from tuisim.app.action import Act, fill_keys
from tuisim.app.panels import PANELS
from tuisim.app.panels.titles import build_title
from tuisim.app.render.lesson import Away, LessonPicture, LessonView, draw_lesson
from tuisim.terminal.cell_view import LinesPanel
from tuisim.terminal.text_runs import escape_markup

if TYPE_CHECKING:
    from tuisim.app.snapshot import Snapshot

_INFO = PANELS["lesson"]


class LessonPanel(LinesPanel, can_focus=True):
    """The lesson panel: the step of the lesson, its result and its hints.

    Args:
        is_brief: Whether the panel only accompanies a log, which has the focus; the title of the step is then in the
            panel's first row.
    """

    ALLOW_SELECT = False
    BINDINGS: ClassVar[list[BindingType]] = [
        ("up", "scroll_text(-1)", "Scroll up"),
        ("down", "scroll_text(1)", "Scroll down"),
        ("pageup", "scroll_text(-8)", "Page up"),
        ("pagedown", "scroll_text(8)", "Page down"),
        ("left", "turn(-1)", "The step before"),
        ("right", "turn(1)", "The next step"),
    ]

    def __init__(self, is_brief: bool = False) -> None:
        super().__init__()
        self._is_brief = is_brief
        self._top = -1 if is_brief else 0
        self.can_focus = not is_brief
        self._content = LessonView()
        self._page: int | None = None
        """The page that the user has turned to; None for that of the step to do."""
        self._first = self._top
        """First row of the text that is shown; -1: the title of the step, whatever the size."""
        self._picture = LessonPicture([])
        self._rows = 0
        """The height at which the text was last drawn."""
        self._is_typing = False

    def watch_has_focus(self, _has_focus: bool) -> None:
        """Show in the frame what the keys of the panel do while the panel has the focus."""
        super().watch_has_focus(_has_focus)
        self._show_subtitle()

    def show(self, snapshot: Snapshot) -> None:
        """Draw the lesson if the panel had no room for it before; `show_lesson` sets the lesson that is shown."""
        if not self._picture.lines:
            self._redraw()

    def show_lesson(self, view: LessonView) -> None:
        """Show another state of the lesson; a new result or step is shown from its first row."""
        if view == self._content and self._picture.lines:
            return
        before = self._content
        self._content = view
        if (view.lesson, view.at, view.judgements) != (before.lesson, before.at, before.judgements):
            self._page = None
            self._first = self._top
        self._redraw()
        if view.hints > before.hints and view.at == before.at:
            # A new hint is at the end of the text: scroll there.
            self._first = self._picture.first + self._picture.below
            self._redraw()

    def _redraw(self) -> None:
        size = self._text.size
        if not size:
            # The panel may have its size before its text has.
            if self.size and self.is_attached:
                self.call_after_refresh(self._redraw)
            return
        page = self._content.page if self._page is None else self._page
        if self._is_brief:
            away = Away.LOG
        elif self._is_typing:
            away = Away.EDITOR
        else:
            away = Away.NO
        rows = size.height
        is_cut = rows < self._rows and not self._picture.below and page == self._content.page
        self._rows = rows
        if is_cut and self._content.asks:
            # A panel that opens below must not cover the question: the title of its step comes first.
            self._first = -1
        self._picture = draw_lesson(self._content, page, self._first, size.width, rows, away)
        if self._first >= 0:
            self._first = self._picture.first
        self._text.set_lines(self._picture.lines)
        self._show_subtitle()

    def _show_subtitle(self) -> None:
        below = self._picture.below
        # Beside a log, the key of this panel does something else, so the title does not name it.
        title = _INFO.title if self._is_brief else build_title(self.app, _INFO.id)
        title += f" ↓{below}" if below else ""
        if title != self.border_title:
            self.border_title = title
        key = "{lesson-back} {lesson-on} read on" if self._is_typing else "{lesson-down} reads on"
        is_read = self.can_focus and (below or (self._is_typing and self.reads_on))
        pages = fill_keys(self.app, key) if is_read else ""
        words = "↑↓ text · ←→ steps · M menu" if self.has_focus else escape_markup(pages)
        if words != self.border_subtitle:
            self.border_subtitle = words

    @property
    def reads_on(self) -> bool:
        """Whether the text of the lesson has more rows above or below the visible ones."""
        return self._picture.first > 0 or self._picture.below > 0

    def set_typing(self, is_typing: bool, is_low: bool = False) -> None:
        """Draw the lesson for a user who types in the program, where the page keys are keys of the editor.

        Args:
            is_typing: Whether the user types; False draws the usual lesson again.
            is_low: Whether there is little room below the editor, so that the title of the step comes first.
        """
        self._is_typing = is_typing
        self._top = -1 if is_typing and is_low else 0
        if self._top:
            self._page = None
            self._first = self._top
        self._redraw()

    def action_scroll_text(self, by: int) -> None:
        self._first = max(0, self._picture.first + by)
        self._redraw()

    def action_turn(self, by: int) -> None:
        page = self._content.page if self._page is None else self._page
        self._page = max(0, min(page + by, self._content.last_page))
        self._first = 0
        self._redraw()

    def on_click(self) -> None:
        """Show the list of lessons if no lesson is open."""
        if not self._content.lesson:
            self.post_message(Act("lesson-menu"))

    def on_mouse_scroll_down(self) -> None:
        self.action_scroll_text(1)

    def on_mouse_scroll_up(self) -> None:
        self.action_scroll_text(-1)
