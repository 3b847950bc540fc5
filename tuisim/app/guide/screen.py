"""The guide in the app: contents or search results at the left, a page at the right, the keys first."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from typing import ClassVar, TypeAlias

from rich.style import Style
from rich.text import Text
from textual import events, on
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.containers import Horizontal, VerticalScroll
from textual.geometry import Size
from textual.widgets import Input, Static, Tree
from textual.widgets.tree import TreeNode

from tuisim.app import background, design
from tuisim.app.action import KeyWord, build_key_table
from tuisim.app.dialogs.dialog import Dialog
from tuisim.app.guide.answers import AnswerList, name_answer
from tuisim.base import palette
from tuisim.base.data_class import dataclass
from tuisim.guide.catalogue import CONTENTS, load_pages
from tuisim.guide.search import SearchResult, load_index, search
from tuisim.guide.text import NO_WORDS, draw_page, find_passage_end, find_rows
from tuisim.terminal.text_runs import Line


@dataclass(frozen=True, slots=True)
class KeyPage:
    """The first page of the guide: how to start, and a table of all keys."""

    title: str
    start: str
    groups: Mapping[str, Iterable[KeyWord]]
    """The keys by the name of their group."""


@dataclass(frozen=True, slots=True)
class Topic:
    """What the guide shows about a panel: a page, and the groups of keys that concern the panel."""

    page: str = ""
    """Name of the guide's page; empty for the page with every key."""
    groups: tuple[str, ...] = ()
    """Names of the groups of keys that stand above the page; on the page with every key, they are the first groups."""


_TIME = ("Program", "Time")

TOPICS: Mapping[str, Topic] = {
    "world": Topic(groups=("Program", "Robot")),
    "lesson": Topic("lessons", ("Lesson",)),
    "instrumentation": Topic("how-sensors-see"),
    "output": Topic("writing-programs", ("Program",)),
    "arrays": Topic("how-sensors-see"),
    "code": Topic("writing-programs", ("In the code", "Program")),
    "chart": Topic("measuring-bands", _TIME),
    "controls": Topic("virtual-time", ("Program",)),
    "positioning": Topic("motion-and-drift", ("Robot",)),
    "noise": Topic("how-sensors-see"),
    "debug": Topic("stepping", ("Debugging",)),
    "brick": Topic("the-brick"),
    "obstacles": Topic("world-files", ("Robot",)),
    "goals": Topic("goal-files"),
    "settings": Topic("options"),
}
"""The topics by the id of the panel that they are about."""


_SIDE_BY_SIDE = 100
_PREVIEW = 66
"""From `_SIDE_BY_SIDE` columns on, the contents stay beside a page that is read; from `_PREVIEW` columns on, a page is
shown beside the contents."""
_SEARCH_AGAIN_S = 0.15
_SEARCHING = "searching …"
_CORNERS = 4
"""Columns of the frame's upper edge that its title cannot have."""

_FOUND = Style(bgcolor=design.CHOSEN)
"""The style of a passage that a search has found."""
_ROWS_OF_PASSAGE = 6
"""If fewer rows of a found passage than this fit below its heading, the view begins with the passage instead."""

Place: TypeAlias = tuple[str, str]
"""The name of a page, empty for the keys, and a heading in it, empty for its beginning."""
KEYS: Place = ("", "")


def _build_text(lines: list[Line], matches: range = range(0)) -> Text:
    """Return lines as a text in which the lines `matches`, found by a search, stand out."""
    text = Text(no_wrap=True)
    for row, line in enumerate(lines):
        for part, style in line:
            text.append(part, style + _FOUND if row in matches else style)
        text.append("\n")
    return text


class _Contents(Tree[Place | None]):
    """The tree of the pages by part; below the open page, its sections and the pages to which it links."""

    def __init__(self) -> None:
        super().__init__("", id="contents")
        self.show_root = False
        self.guide_depth = 2
        self.auto_expand = False

    def show_all(self, keys: str) -> None:
        """Show the pages of the guide.

        Args:
            keys: Title of the page with the keys.
        """
        self.clear()
        self.root.add_leaf(keys, KEYS)
        for part, names in CONTENTS.items():
            branch = self.root.add(Text(part, f"bold {palette.BLUE}"), None, expand=True)
            for name in names:
                self._add_page(branch, name)

    def _add_page(self, branch: TreeNode[Place | None], name: str) -> None:
        page = load_pages()[name]
        node = branch.add(page.title, (name, ""))
        for heading in page.list_headings():
            node.add_leaf(heading, (name, heading))
        for other in page.list_links():
            node.add_leaf(f"→ {load_pages()[other].title}", (other, ""))

    def say(self, words: str) -> None:
        """Show a message about a search in place of the pages."""
        self.clear()
        self.root.add_leaf(words, None)

    def go_to(self, place: Place) -> None:
        """Move the cursor to a page or section, without opening it."""
        node = next((node for node in self.walk() if node.data == place), None)
        if node is not None:
            self.move_cursor(node)

    def walk(self) -> list[TreeNode[Place | None]]:
        """Return every node of the tree below its root, level by level."""
        nodes = []
        level = list(self.root.children)
        while level:
            nodes += level
            level = [child for node in level for child in node.children]
        return nodes


class _Page(VerticalScroll):
    """The widget that shows a page of the guide, drawn for its width.

    Args:
        keys: The page with every key.
        topic: The page that is shown first.
    """

    def __init__(self, keys: KeyPage, topic: Topic) -> None:
        super().__init__(id="page")
        self._keys = keys
        self._topic = topic
        self.place: Place = (topic.page, "")
        """The name of the page in view, and the heading of the section to which the user went."""
        self._with_keys = bool(topic.page)
        """Whether the keys of the topic stand above the page."""
        self._passage = ""
        """The passage of the page that a search has found, in Markdown; empty for none."""
        self.drawn_columns = 0
        """Width in columns for which the page was last drawn; 0 if the page was not visible."""
        self._text = Static(markup=False)

    def compose(self) -> ComposeResult:
        yield self._text

    def on_resize(self) -> None:
        if self.scrollable_content_region.width != self.drawn_columns:
            self._draw()

    def show(self, place: Place, matches: SearchResult | None = None) -> None:
        """Show another page or section; with `matches`, show the passage that a search has found on the page."""
        self.place = place
        self._with_keys = False
        self._passage = matches.passage if matches else ""
        self._draw()

    def _draw(self) -> None:
        self.drawn_columns = width = self.scrollable_content_region.width
        if not width:
            return
        name, heading = self.place
        if not name:
            groups = {
                group: self._keys.groups[group]
                for group in (*self._topic.groups, *self._keys.groups)
            }
            self._text.update(
                Text(f"{self._keys.start}\n\n").append_text(build_key_table(groups, width))
            )
            self.scroll_home(animate=False)
            return
        lines = draw_page(load_pages()[name], width)
        top, row = find_rows(lines, heading, self._passage)
        drawn = _build_text(lines, range(row, find_passage_end(lines, row, self._passage)))
        groups = {
            group: self._keys.groups[group] for group in self._topic.groups if self._with_keys
        }
        self._text.update(
            build_key_table(groups, width).append("\n").append_text(drawn) if groups else drawn
        )
        # Begin with the heading if enough of the passage is in view below it, else with the passage.
        near = row - top < self.scrollable_content_region.height - _ROWS_OF_PASSAGE
        if near:
            first = top
        elif lines[row - 1]:
            first = row
        else:
            first = row - 1
        self.call_after_refresh(self.scroll_to, y=first, animate=False)


class GuideScreen(Dialog[None]):
    """The guide; Escape or `?` closes it.

    Args:
        keys: The page with every key.
        topic: The page that is shown first.
    """

    TITLE_TEXT = "Guide"
    HINT = "type to search · Enter opens · tab switch · esc closes"
    BINDINGS: ClassVar[list[BindingType]] = [
        ("question_mark,q", "leave", "Close"),
        ("slash", "search", "Search"),
        ("tab,shift+tab", "other_side", "Contents or page"),
        ("left", "contents", "Contents"),
        ("down", "down", "Contents or next answer"),
        ("right", "page", "Page"),
        ("pagedown", "scroll_answers(1)", "Next answers"),
        ("pageup", "scroll_answers(-1)", "Previous answers"),
    ]

    def __init__(self, keys: KeyPage, topic: Topic) -> None:
        super().__init__()
        self._keys = keys
        self._topic = topic
        self._question = self._answered = self._at_first = ""
        self._found: list[SearchResult] = []

    def can_take(self, event: events.Event) -> bool:
        """Return whether the guide can handle an event now; a key that needs the results of a search waits for them."""
        leads_there = isinstance(event, events.Key) and event.key in (
            "enter",
            "down",
            "tab",
            "shift+tab",
        )
        return super().can_take(event) and not (leads_there and self._answered != self._question)

    def on_key(self, event: events.Key) -> None:
        """Begin a search with a typed letter; `?` closes the guide instead."""
        if event.character and event.character.isalnum() and event.key != "q":
            event.stop()
            self._search.focus()
            self._search.insert_text_at_cursor(event.character)

    def compose_content(self) -> ComposeResult:
        yield Input(
            placeholder="Search: words or a question",
            compact=True,
            select_on_focus=False,
            id="search",
        )
        with Horizontal(id="both"):
            yield _Contents()
            yield AnswerList()
            yield _Page(self._keys, self._topic)

    def on_mount(self) -> None:
        super().on_mount()
        self._contents.show_all(self._keys.title)
        # The first search needs the index, which takes a second to build.
        background.run(self, load_index, lambda _: None, group="index")
        if self._at_first:
            self._search.value = self._at_first
            self._search.focus()
        else:
            self._page.focus()
        self.call_after_refresh(self._contents.go_to, self.place)

    def ask(self, question: str) -> None:
        """Let the guide begin with the search for a question; to be called before the screen is shown."""
        self._at_first = question

    @property
    def _contents(self) -> _Contents:
        return self.query_one(_Contents)

    @property
    def _answers(self) -> AnswerList:
        return self.query_one(AnswerList)

    @property
    def _page(self) -> _Page:
        return self.query_one(_Page)

    @property
    def _search(self) -> Input:
        return self.query_one("#search", Input)

    @property
    def answers(self) -> Sequence[SearchResult]:
        """The results of the search, the best answer first."""
        return self._found if self._answered == self._question else []

    @property
    def place(self) -> Place:
        """The page in view, and the section to which the user went."""
        return self._page.place

    def on_resize(self) -> None:
        self._arrange(self._page.has_focus)
        # The widgets may be removed by then, and a query would fail.
        answers, room = self._answers, self.query_one("#both")
        self.call_after_refresh(lambda: answers.fit(room.size))

    @property
    def _room(self) -> Size:
        return self.query_one("#both").size

    def on_descendant_focus(self, event: events.DescendantFocus) -> None:
        # While a search begins, the page stays as it is until there are results.
        if event.widget is not self._search or self._found:
            self._arrange(event.widget is self._page)

    def _arrange(self, reading: bool) -> None:
        """Show either the answers of a search or a page; without a search, show the contents as well if there is room.

        Args:
            reading: Whether the user reads a page.
        """
        columns = self.app.size.width
        searched = bool(self._found)
        self._answers.display = searched and not reading
        self._contents.display = not searched and (columns >= _SIDE_BY_SIDE or not reading)
        self._page.display = reading or (not searched and columns >= _PREVIEW)
        self._frame(reading)

    def _frame(self, reading: bool) -> None:
        """Show in the frame which keys work and, while an answer is read, the section of that answer.

        Args:
            reading: Whether the user reads a page.
        """
        frame = self.query_one(".dialog")
        one = self._answers.chosen
        frame.border_title, frame.border_subtitle = self.TITLE_TEXT, self.HINT
        if self._question.strip() and self._answered != self._question:
            frame.border_subtitle = _SEARCHING
        elif self._found and not reading:
            frame.border_subtitle = "↑ ↓ answers · Enter opens · / search · esc back"
        elif self._found and one is not None:
            frame.border_title = self._title_of(one)
            frame.border_subtitle = "esc back to the answers · / search"

    def _title_of(self, one: SearchResult) -> str:
        """Return the names of an answer's page and section; if there is no room for both, only the section's."""
        names = [self.TITLE_TEXT, *filter(None, reversed(name_answer(one)))]
        titles = [" · ".join(names[first:]) for first in range(len(names))]
        return next(
            (title for title in titles if len(title) <= self._room.width - _CORNERS), titles[-1]
        )

    @on(Tree.NodeHighlighted)
    def _preview(self, event: Tree.NodeHighlighted[Place | None]) -> None:
        if event.node.data is not None and self._contents.has_focus:
            self._page.show(event.node.data)

    @on(Tree.NodeSelected)
    def _open(self, event: Tree.NodeSelected[Place | None]) -> None:
        if event.node.data is None:
            event.node.toggle()
            return
        self._page.show(event.node.data)
        self.action_page()

    @on(AnswerList.OptionSelected)
    def _read(self) -> None:
        """Open the page of the highlighted answer."""
        if (one := self._answers.chosen) is not None:
            self.action_page()
            self._page.show((one.name, one.heading), one)

    @on(Input.Changed)
    def _type(self, event: Input.Changed) -> None:
        self._question = event.value
        self.set_timer(_SEARCH_AGAIN_S, partial(self._ask, event.value))

    def _ask(self, question: str) -> None:
        if question != self._question:
            return
        if not question.strip():
            self._found = []
            self._answered = question
            self._contents.show_all(self._keys.title)
            self._arrange(self._page.has_focus)
            self._tell_answered()
            return
        self._frame(reading=False)
        work: Callable[[], list[SearchResult]] = partial(search, question)
        background.run(self, work, partial(self._answer, question), group="search", exclusive=True)

    def _answer(self, question: str, found: list[SearchResult]) -> None:
        if question != self._question or self.is_closed:
            return
        self._found = found
        self._answered = question
        self._arrange(self._page.has_focus)
        self._answers.show(question, found, self._room)
        if not found:
            self._contents.say(NO_WORDS)
        self._tell_answered()

    def _tell_answered(self) -> None:
        self.app.post_message(self.Changed())

    @on(Input.Submitted)
    def _open_first(self) -> None:
        """Open the page of the best answer."""
        if self._found:
            self._read()
        else:
            self.action_contents()

    def action_search(self) -> None:
        self._search.focus()
        self._search.select_all()

    def action_down(self) -> None:
        """Move the focus from the search field down to the contents or, after a search, to the second answer."""
        if self._search.has_focus and len(self._found) > 1:
            self._answers.highlighted = 1
        self.action_contents()

    def action_scroll_answers(self, pages: int) -> None:
        """Scroll the answers by a number of pages, also while the field has the focus; negative scrolls up."""
        self.action_contents()
        if self._found:
            move = self._answers.action_page_down if pages > 0 else self._answers.action_page_up
            move()  # type: ignore[no-untyped-call]

    def action_contents(self) -> None:
        """Move the focus to the answers of a search; without them, to the contents."""
        self._arrange(reading=False)
        (self._answers if self._found else self._contents).focus()

    def action_page(self) -> None:
        self._arrange(reading=True)
        self._page.focus()

    def action_other_side(self) -> None:
        if self._contents.has_focus:
            self.action_page()
        elif self._answers.has_focus:
            self._read()
        else:
            self.action_contents()

    def action_leave(self) -> None:
        """Go one step back: from an answer's page to the answers, from a search to the contents, else close."""
        if self._found and self._page.has_focus:
            self.action_contents()
        elif self._search.value:
            self._search.value = ""
            self._found = []
            self.action_contents()
        else:
            self.dismiss(None)
