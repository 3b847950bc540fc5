"""Lists of options without room, and clicks on options that are gone."""

from __future__ import annotations

import pytest
from rich.style import Style
from textual.app import ComposeResult
from textual.command import CommandList
from textual.events import Click
from textual.widgets import OptionList

from tuisim.app.terminal.terminal_app import TerminalApp


class _Listed(TerminalApp):
    def __init__(self, listed: OptionList) -> None:
        super().__init__()
        self._listed = listed

    def compose(self) -> ComposeResult:
        yield self._listed


@pytest.mark.parametrize("key", ["pageup", "pagedown"])
async def test_a_list_without_room_bears_the_keys_for_pages(key: str) -> None:
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
async def test_a_click_on_an_option_that_is_gone_does_nothing(kind: type[OptionList]) -> None:
    listed = kind("first", "second")
    async with _Listed(listed).run_test(size=(40, 12)) as pilot:
        listed.highlighted = 0
        for at, highlighted in ((2, 0), (1, 1)):
            clicked = Style.from_meta({"option": at})
            listed.post_message(Click(listed, 1, 1, 0, 0, 1, False, False, False, style=clicked))
            await pilot.pause()
            assert listed.highlighted == highlighted
