"""Each key has its turn: everything that follows from it comes before the next one."""

from __future__ import annotations

from typing import ClassVar

import pytest
from textual import events
from textual.app import App, ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.widgets import Input

from tests.app.app_help import until
from tests.app.monkey import at_once
from tuisim.terminal import input_order
from tuisim.terminal.input_order import InputOrder, Turn


class _App(App[None]):
    """A field within several parents, all of which a key passes on its way to the app."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("f5", "later", "Later"),
        Binding("f6", "never", "Never"),
    ]

    def __init__(self) -> None:
        super().__init__()
        self.waits = False
        self.order = InputOrder(self, super().on_event, lambda _: self.waits)

    def compose(self) -> ComposeResult:
        with Vertical(), Vertical(), Vertical():
            yield Input()

    async def on_event(self, event: events.Event) -> None:
        if isinstance(event, events.InputEvent) and not event.is_forwarded:
            await self.order.take(event)
        else:
            await super().on_event(event)

    def action_later(self) -> None:
        self.call_after_refresh(self.type_later)

    def action_never(self) -> None:
        turn = self.order._turn
        assert isinstance(turn, Turn)
        turn.add(Input())

    def type_later(self) -> None:
        self.query_one(Input).insert_text_at_cursor("[later]")

    @property
    def typed(self) -> str:
        return self.query_one(Input).value


BURSTS = {
    "backspace": ("a b backspace c", "ac"),
    "arrows": ("a left b right c", "bac"),
    "home and end": ("a home b end c", "bac"),
    "what a key lets do after the next refresh": ("a f5 b", "a[later]b"),
}


@pytest.mark.parametrize("keys, typed", BURSTS.values(), ids=list(BURSTS))
async def test_keys_typed_in_a_burst_keep_their_order(keys: str, typed: str) -> None:
    app = _App()
    async with app.run_test() as pilot:
        at_once(pilot, keys.split())
        await until(pilot, lambda: app.order.is_idle and bool(app.typed))
        assert app.typed == typed


async def test_keys_typed_while_a_screen_opens_wait_until_it_can_take_them() -> None:
    app = _App()
    async with app.run_test() as pilot:
        app.waits = True
        at_once(pilot, ["a", "backspace", "b"])
        await pilot.pause()
        assert app.typed == ""
        app.waits = False
        await until(pilot, lambda: app.order.is_idle)
        assert app.typed == "b"


async def test_a_key_whose_handling_never_ends_does_not_block_later_keys_for_ever(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(input_order, "_PATIENCE_S", 0.01)
    app = _App()
    async with app.run_test() as pilot:
        at_once(pilot, ["f6", "a"])
        await until(pilot, lambda: app.typed == "a")
