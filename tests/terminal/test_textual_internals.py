"""Every widget is told its size, what is gone leaves the screen; lists without room, clicks on gone options."""

from __future__ import annotations

import dis
import pkgutil
from collections.abc import Iterator
from importlib import import_module
from types import CodeType, ModuleType
from typing import Any

import pyte
import pytest
from rich.style import Style
from textual import events
from textual.app import ComposeResult
from textual.command import CommandList
from textual.events import Click
from textual.geometry import Size
from textual.message import Message
from textual.screen import Screen
from textual.widget import Widget
from textual.widgets import OptionList

import tuisim.app
import tuisim.terminal
from tests.app.app_help import LOGS, open_lab, ready, settings, until
from tests.app.wires import on_wire, until_quiet, wire_of
from tuisim.app.app import LabApp
from tuisim.app.terminal_app import TerminalApp
from tuisim.terminal import textual_internals


@pytest.fixture
def told(monkeypatch: pytest.MonkeyPatch) -> dict[Widget, Size]:
    """The size that each widget was last told; before each layout, somebody asks for the size of every widget."""
    lay_out = Screen._refresh_layout
    post = Widget.post_message
    sizes = {}

    def asked_for(screen: Screen[object], *words: object, **more: object) -> None:
        screen._compositor.update_widgets(screen._dirty_widgets)
        assert all(widget.size is not None for widget in screen.walk_children(Widget))
        lay_out(screen, *words, **more)  # type: ignore[arg-type]

    def posted(widget: Widget, message: Message) -> bool:
        if isinstance(message, events.Resize):
            sizes[widget] = message.size
        return post(widget, message)

    monkeypatch.setattr(Screen, "_refresh_layout", asked_for)
    monkeypatch.setattr(Widget, "post_message", posted)
    return sizes


@pytest.mark.quick_cases("80x24")
@pytest.mark.parametrize(
    "size, last",
    [((80, 24), "instrumentation"), ((120, 40), "code"), ((200, 60), "chart")],
    ids=["80x24", "120x40", "200x60"],
)
async def test_every_widget_gets_a_resize_event_with_its_size(
    size: tuple[int, int], last: str, told: dict[Widget, Size]
) -> None:
    async with open_lab(LOGS, size=size) as (pilot, app):
        await until(
            pilot, lambda: app.panel_area.is_shown(last) and app.panel_area.panels[last].is_mounted
        )
        await pilot.pause()
        laid_out = app.screen._compositor.full_map
        widgets = [
            widget
            for panel in app.panel_area.panels.values()
            for widget in panel.walk_children(with_self=True)
        ]
        shown = {widget: laid_out[widget].region.size for widget in widgets if widget in laid_out}
        assert len(shown) > 5
        assert {widget: told.get(widget) for widget in shown} == shown


class _Listed(TerminalApp):
    def __init__(self, listed: OptionList) -> None:
        super().__init__()
        self._listed = listed

    def compose(self) -> ComposeResult:
        yield self._listed


@pytest.mark.parametrize("key", ["pageup", "pagedown"])
async def test_page_keys_in_a_list_without_room_raise_no_error(key: str) -> None:
    listed = OptionList("first", "second", "third")
    async with _Listed(listed).run_test(size=(40, 12)) as pilot:
        listed.highlighted = 1
        listed.focus()
        listed.styles.height = 2
        await pilot.pause()
        assert not listed.scrollable_content_region
        await pilot.press(key)
        assert listed.highlighted == 1


@pytest.mark.parametrize("kind", [OptionList, CommandList])
async def test_clicking_an_option_that_was_removed_does_nothing(kind: type[OptionList]) -> None:
    listed = kind("first", "second")
    async with _Listed(listed).run_test(size=(40, 12)) as pilot:
        listed.highlighted = 0
        for at, highlighted in ((2, 0), (1, 1)):
            clicked = Style.from_meta({"option": at})
            listed.post_message(Click(listed, 1, 1, 0, 0, 1, False, False, False, style=clicked))
            await pilot.pause()
            assert listed.highlighted == highlighted


@pytest.mark.slow
async def test_a_notice_that_has_expired_is_removed_from_the_screen(
    told: dict[Widget, Size],
) -> None:
    async with on_wire(LabApp(settings(LOGS)), notifications=True) as pilot:
        app = await ready(pilot)
        await until_quiet(pilot)
        terminal = pyte.Screen(120, 40)
        stream = pyte.Stream(terminal)
        app.notify("A notice", timeout=60)
        await until_quiet(pilot)
        stream.feed("".join(wire_of(pilot).sent))
        assert "A notice" in "\n".join(terminal.display)
        wire_of(pilot).sent.clear()
        # What is drawn meanwhile is not known in the map of all widgets: it is made anew for who asks.
        app.screen._compositor._full_map_invalidated = True
        app.clear_notifications()
        await until_quiet(pilot)
        stream.feed("".join(wire_of(pilot).sent))
        assert "A notice" not in "\n".join(terminal.display)


def _names_of(kind: type, package: str) -> set[str]:
    """The private names that the classes of a package give a class: of methods, and of attributes that they set."""
    found: set[str] = set()
    for base in kind.__mro__:
        if base.__module__.startswith(package):
            made: Any = vars(base).get("__init__")
            sets = dis.get_instructions(made) if hasattr(made, "__code__") else ()
            found |= {*vars(base), *(one.argval for one in sets if one.opname == "STORE_ATTR")}
    return {name for name in found if name.startswith("_") and not name.startswith("__")}


def _codes(code: CodeType) -> Iterator[CodeType]:
    """A function's code and that of the functions in it."""
    yield code
    for inner in code.co_consts:
        if isinstance(inner, CodeType):
            yield from _codes(inner)


def _used(kind: type) -> set[str]:
    """The names that the functions of a class use."""
    functions = (getattr(one, "fget", one) for one in vars(kind).values())
    codes = (getattr(one, "__code__", None) for one in functions)
    return {name for code in codes if code for inner in _codes(code) for name in inner.co_names}


def test_no_class_elsewhere_overrides_or_uses_private_names_of_textual() -> None:
    uses: list[str] = []
    for info in pkgutil.walk_packages(tuisim.app.__path__, "tuisim.app."):
        uses += _uses(import_module(info.name))
    for info in pkgutil.walk_packages(tuisim.terminal.__path__, "tuisim.terminal."):
        if info.name != textual_internals.__name__:
            uses += _uses(import_module(info.name))
    assert uses == []


def _uses(module: ModuleType) -> list[str]:
    found = []
    for kind in vars(module).values():
        if isinstance(kind, type) and kind.__module__ == module.__name__:
            theirs = _names_of(kind, "textual")
            overridden = theirs & {name for name, one in vars(kind).items() if callable(one)}
            used = (theirs & _used(kind)) - _names_of(kind, "tuisim")
            found += [
                f"{module.__name__}.{kind.__name__}.{name}" for name in sorted(overridden | used)
            ]
    return found


def test_the_check_of_textuals_private_names_finds_a_missing_one(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    assert textual_internals.list_missing_names() == []
    monkeypatch.delattr(OptionList, "_move_page")
    assert textual_internals.list_missing_names() == ["OptionList._move_page"]


def test_a_character_is_its_own_key_where_textual_has_no_name_for_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    assert textual_internals.find_key("?") == "question_mark"
    monkeypatch.delattr("textual.keys._character_to_key")
    assert textual_internals.find_key("?") == "?"
    assert textual_internals.list_missing_names() == ["keys._character_to_key"]
