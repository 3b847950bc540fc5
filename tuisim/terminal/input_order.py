"""Input in the order of its arrival: the next key is handled when everything that the last one has caused is done.

Textual hands a key to the widget with the focus. The widget takes letters at once; every other key goes on through the
queue of each parent up to the app, which looks up its binding there. So a letter that arrives in the same burst is
typed before the backspace, the arrow or the Enter in front of it has an effect. Here a key has its turn: messages that
are posted while something of the turn is handled belong to it, and so do the callbacks that wait for the end of a
message or, unless they are Textual's own, for the next refresh. The turn ends when none of them is left.
"""

from __future__ import annotations

import asyncio
import threading
from asyncio import TimerHandle
from collections import Counter, deque
from collections.abc import Awaitable, Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from functools import partial
from typing import Any
from weakref import WeakSet

from textual import events
from textual.app import App
from textual.message import Message
from textual.message_pump import MessagePump
from textual.widget import Widget
from textual.widgets import Input

from tuisim.terminal.textual_internals import (
    CALL_LATER,
    CALL_NEXT,
    DISPATCH,
    END,
    POST,
    invoke,
    route_messages,
)

_PATIENCE_S = 1.0
"""Seconds without any step after which a turn is over: what it still waits for may never come."""
_ASK_AGAIN_S = 0.1
"""Seconds between two checks whether the target of a waiting key is there, for a target that does not say so."""
_POINTER = (events.MouseMove, events.MouseScrollDown, events.MouseScrollUp)
"""Events that come in floods: they keep their place in the order, but have no turn of their own."""
_TURN = "_turn"
"""Attribute of a message that belongs to a turn."""


class Turn:
    """One key, with all messages and callbacks that follow from it; a turn ends when all of them were handled.

    Args:
        ended: Called once, when the turn ends.
    """

    def __init__(self, ended: Callable[[], None]) -> None:
        self._ended = ended
        self._left: Counter[MessagePump] = Counter()
        """Number of messages and callbacks of the turn that a pump still has to handle."""
        self._thread_id = threading.get_ident()
        self.is_over = False
        self.steps = 0
        """Number of messages and callbacks of the turn that were handled."""
        _live.add(self)
        _follow_turns()

    @contextmanager
    def step(self, pump: MessagePump) -> Iterator[None]:
        """In a `with` block, handle one message or callback of the turn; at the end of the block, it counts as handled.

        Messages that are posted in the block belong to the turn, too.
        """
        token = _current.set(self)
        try:
            yield
        finally:
            _current.reset(token)
            self.drop(pump, 1)

    def add(self, pump: MessagePump) -> None:
        """Add one message or callback to the turn: the turn does not end before its message pump has handled it."""
        self._left[pump] += 1

    def drop(self, pump: MessagePump, count: int | None = None) -> None:
        """Remove messages and callbacks of a message pump from the turn; end the turn if none is left.

        Args:
            pump: The message pump.
            count: How many the pump has handled; None removes all, because the pump is gone and never handles them.
        """
        self.steps += 1
        self._left[pump] -= self._left[pump] if count is None else count
        if self._left[pump] <= 0:
            del self._left[pump]
        if not self._left:
            self.end()

    def end(self) -> None:
        """End the turn, so that the next key is handled."""
        if not self.is_over:
            self.is_over = True
            self._left.clear()
            _live.discard(self)
            _follow_turns()
            self._ended()

    def delay(self, pump: MessagePump, callback: Callable[[], Any]) -> Callable[[], Awaitable[Any]]:
        """Add a callback to the turn, and return a function that calls it.

        Messages and callbacks that follow from this call belong to the turn, too.
        """
        self.add(pump)

        async def call() -> Any:
            with self.step(pump):
                return await invoke(callback)

        return call

    @property
    def is_here(self) -> bool:
        """Whether the turn has not ended, and was begun in the current thread."""
        return not self.is_over and threading.get_ident() == self._thread_id


_current: ContextVar[Turn | None] = ContextVar("turn", default=None)
"""The turn to which the message or callback belongs that is being handled. Tasks and threads inherit it, also for
longer than it lasts."""
_live: WeakSet[Turn] = WeakSet()


def _turn() -> Turn | None:
    turn = _current.get()
    return turn if turn is not None and turn.is_here else None


def post_message(pump: MessagePump, message: Message) -> bool:
    """Post a message, and add it to the `Turn` in which this is called; return whether it was posted.

    A message that Textual may replace by a later one, such as one about drawing, is not added.
    """
    turn = _turn()
    if turn is None or type(message).can_replace is not Message.can_replace:
        return POST(pump, message)
    turn.add(pump)
    setattr(message, _TURN, turn)
    posted = POST(pump, message)
    if not posted:
        turn.drop(pump, 1)
    return posted


def dispatch_message(pump: MessagePump, message: Message) -> Awaitable[None]:
    """Handle a message; what follows from it belongs to the same `Turn` as the message itself."""
    turn: Turn | None = getattr(message, _TURN, None)
    # Nobody posts the events of a new widget: they belong to the turn in which it was made.
    if turn is None and (
        _current.get() is None or isinstance(message, (events.Compose, events.Mount))
    ):
        return DISPATCH(pump, message)
    return _dispatch_message(turn, pump, message)


async def _dispatch_message(turn: Turn | None, pump: MessagePump, message: Message) -> None:
    if turn is not None:
        with turn.step(pump):
            await DISPATCH(pump, message)
        return
    token = _current.set(None)
    try:
        await DISPATCH(pump, message)
    finally:
        _current.reset(token)


async def end_messages(widget: Widget) -> None:
    """Clean up after the last message of a removed widget, and remove its unhandled messages from their `Turn`."""
    try:
        await END(widget)
    finally:
        for turn in [*_live]:
            turn.drop(widget)


def call_next(pump: MessagePump, callback: Callable[..., Any], *args: Any, **kwargs: Any) -> None:
    """Call a function after the message pump's current message.

    The call belongs to the `Turn` in which this is called.
    """
    if turn := _turn():
        CALL_NEXT(pump, turn.delay(pump, partial(callback, *args, **kwargs)))
    else:
        CALL_NEXT(pump, callback, *args, **kwargs)


def call_after_refresh(
    pump: MessagePump, callback: Callable[..., Any], *args: Any, **kwargs: Any
) -> bool:
    """Call a function after the message pump's next refresh; return whether it will be called.

    The call belongs to the `Turn` in which this is called. Only Textual's own callbacks, which scroll, belong to none.
    """
    turn = _turn()
    if turn is None or _find_module(callback).startswith("textual."):
        return CALL_LATER(pump, callback, *args, **kwargs)
    is_posted = CALL_LATER(pump, turn.delay(pump, partial(callback, *args, **kwargs)))
    if not is_posted:
        turn.drop(pump, 1)
    return is_posted


def _follow_turns() -> None:
    """Make Textual use the functions of this module while any turn goes on, and its own functions otherwise.

    Most messages are about drawing, and Textual's own functions are quicker.
    """
    if _live:
        route_messages(post_message, dispatch_message, call_next, call_after_refresh)
    else:
        route_messages(POST, DISPATCH, CALL_NEXT, CALL_LATER)


def takes_letters(widget: Widget) -> bool:
    """Return whether a widget takes every letter as text.

    The widget's attribute `takes_letters` says so. Without this attribute, the result is True only for an `Input`.
    """
    return bool(getattr(widget, "takes_letters", isinstance(widget, Input)))


def _find_module(callback: Callable[..., Any]) -> str:
    while isinstance(callback, partial):
        callback = callback.func
    return getattr(callback, "__module__", None) or ""


class InputOrder:
    """Handles keys and other input of the user in order: each event after everything that the former event has caused.

    Args:
        app: The app.
        give: Handles an event.
        waits: Returns whether an event has to wait because its target is still being opened.
    """

    def __init__(
        self,
        app: App[Any],
        give: Callable[[events.Event], Awaitable[None]],
        waits: Callable[[events.Event], bool],
    ) -> None:
        self._app = app
        self._give = give
        self._waits = waits
        self._held: deque[events.Event] = deque()
        self._turn: Turn | None = None
        self._typed_into: Widget | None = None
        """The widget that took the last key as a letter."""
        self._timer: TimerHandle | None = None
        self._asks_again = False

    @property
    def is_idle(self) -> bool:
        """Whether all events of the user were handled, with everything that followed from them."""
        return not self._held and self._turn is None

    async def take(self, event: events.Event) -> None:
        """Handle an event after all earlier events; if these are not handled yet, store the event until then."""
        if (
            self._held
            and isinstance(event, events.MouseMove)
            and isinstance(self._held[-1], events.MouseMove)
        ):
            self._held.pop()
        self._held.append(event)
        await self.release_inputs()

    async def release_inputs(self) -> None:
        """Handle the stored events that need not wait any longer."""
        while self._held and not self._waits(self._held[0]):
            into = self._find_field(self._held[0])
            if self._turn is not None and (into is None or into is not self._typed_into):
                return
            event = self._held.popleft()
            self._typed_into = into
            await (self._give if isinstance(event, _POINTER) else self._give_turn)(event)
        if self._held and self._turn is None and not self._asks_again:
            self._asks_again = True
            self._app.set_timer(_ASK_AGAIN_S, self._ask_again)

    async def _ask_again(self) -> None:
        self._asks_again = False
        await self.release_inputs()

    def _find_field(self, event: events.Event) -> Widget | None:
        """Return the focused field if an event is a letter that is typed into it; else None."""
        if not (isinstance(event, events.Key) and event.is_printable and self._app.screen_stack):
            return None
        focused = self._app.focused
        return focused if focused is not None and takes_letters(focused) else None

    async def _give_turn(self, event: events.Event) -> None:
        """Handle an event of the user as a new turn or, if a turn goes on, as a further step of that turn."""
        turn = self._turn
        is_new = self._turn is None
        if turn is None:
            turn = self._turn = Turn(self._end_turn)
        turn.add(self._app)
        with turn.step(self._app):
            await self._give(event)
        if is_new and not turn.is_over:
            self._watch(turn)

    def _watch(self, turn: Turn) -> None:
        self._timer = asyncio.get_running_loop().call_later(
            _PATIENCE_S, self._check, turn, turn.steps
        )

    def _check(self, turn: Turn, steps: int) -> None:
        if not turn.is_over:
            turn.end() if turn.steps == steps else self._watch(turn)

    def _end_turn(self) -> None:
        self._turn = None
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None
        if self._held:
            self._app.call_later(self.release_inputs)
