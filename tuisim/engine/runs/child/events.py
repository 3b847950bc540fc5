"""The events that a child sends, with a check that it may send them: its program can write to the pipe as well."""

from __future__ import annotations

import os
from dataclasses import asdict

import msgspec

from tuisim.base.errors import HostError
from tuisim.engine.core.plugged import PluggedPart
from tuisim.engine.protocol import (
    EVENTS,
    PROTOCOL_VERSION,
    BusyLoop,
    Ended,
    InputWanted,
    Inspected,
    LineHistory,
    Message,
    Paused,
    Plugged,
    ReplyWanted,
    Resumed,
    Spoke,
    Started,
    Wheels,
)
from tuisim.engine.runs.run_options import RunOptions

MAX_EVENT_BYTES = 8 << 20
"""Largest size of an event in bytes; no event of a real run is as large."""
MAX_BURST_BYTES = 1 << 20
"""Bytes that one read takes at most, as many as a pipe of Linux can hold; the rest follows with the next read."""
_CHUNK_BYTES = 1 << 16
_MAX_SHOWN = 60
_MAX_NUMBER = 1 << 53
"""Larger than any integer in an event, in either direction; that of nanoseconds is 104 days."""

_Kinds = tuple[type[Message], ...]
DEBUGGED: _Kinds = (Paused, Resumed, Inspected, LineHistory, BusyLoop)
"""Events of a run that can be paused."""


class _Envelope(msgspec.Struct):
    kind: str


def decode_event(line: bytes) -> Message:
    """Return the event in one line that the child has sent.

    Raises:
        HostError: the line is not an event of this protocol.
    """
    try:
        kind = EVENTS[msgspec.json.decode(line, type=_Envelope).kind]
        event = msgspec.json.decode(line, type=kind)
        if not _is_sound(asdict(event)):
            raise ValueError(line)
        if isinstance(event, Plugged):
            # This raises a ValueError if there is no such part.
            build_part(event)
    except (msgspec.MsgspecError, ValueError, KeyError, RecursionError) as error:
        raise HostError(
            f"the program's process sent an invalid message: {line[:_MAX_SHOWN]!r}"
        ) from error
    return event


def build_part(event: Plugged) -> PluggedPart:
    """Return the part that was plugged in, as the event describes it.

    Raises:
        ValueError: there is no such part.
    """
    return PluggedPart(event.port, event.part, event.tick, event.line, event.role)


def _is_sound(value: object) -> bool:
    """Return whether all whole numbers in a value of an event, at any depth, are small enough to store and show."""
    match value:
        case int():
            return abs(value) < _MAX_NUMBER
        case dict():
            return all(map(_is_sound, value.values()))
        case tuple() | list():
            return all(map(_is_sound, value))
        case _:
            return True


class EventStream:
    """The events that a child sends through a pipe, read without blocking.

    Each event is checked, because the program in the child could write to the pipe, too.

    Args:
        descriptor: The read end of the pipe, non-blocking.
        allowed: The classes of events that this run can send, besides those that every run can send.
    """

    def __init__(self, descriptor: int, allowed: _Kinds) -> None:
        self._descriptor = descriptor
        self._allowed: _Kinds = (Started, Spoke, Wheels, Ended, *allowed)
        self._rest = b""
        self._last: Message | None = None
        self.at_end = False
        """Whether all writers have closed the pipe."""
        self.falsified = ""
        """Why the events cannot come from the simulation; no more are read then. Empty if they can."""

    def allow(self, kinds: _Kinds) -> None:
        """Accept further classes of events from now on, because the host has requested them."""
        self._allowed = (*self._allowed, *kinds)

    def read(self) -> list[Message]:
        """Return the events that have arrived.

        An event that the simulation never sends, and all later ones, are left out; `falsified` then says why.
        """
        events: list[Message] = []
        for line in self._split_lines():
            event = self._decode_event(line)
            if event is None:
                break
            events.append(event)
            self._last = event
        return events

    def _split_lines(self) -> list[bytes]:
        data = self._rest
        left = MAX_BURST_BYTES
        while left > 0 and not self.at_end and not self.falsified:
            try:
                chunk = os.read(self._descriptor, _CHUNK_BYTES)
            except BlockingIOError:
                break
            self.at_end = not chunk
            data += chunk
            left -= len(chunk)
        *lines, self._rest = data.split(b"\n")
        if len(self._rest) > MAX_EVENT_BYTES:
            self.falsified = "the program's process sent a message without an end"
        return lines

    def _decode_event(self, line: bytes) -> Message | None:
        """Return the event in a line.

        Return None, and set `falsified` to the reason, if the line is not an event or the event is not allowed now.
        """
        try:
            event = decode_event(line)
        except HostError as error:
            self.falsified = str(error)
            return None
        is_first, is_start = self._last is None, isinstance(event, Started)
        match event:
            case Started(protocol=number) if number != PROTOCOL_VERSION:
                self.falsified = (
                    f"the program's process speaks protocol {number}, this is {PROTOCOL_VERSION}"
                )
            case _ if not isinstance(event, self._allowed) or isinstance(self._last, Ended):
                self.falsified = (
                    f"the program's process sent the message {event.kind}, which must not come here"
                )
            # A run that cannot begin sends its end without a start before it.
            case _ if is_start != is_first and not (is_first and isinstance(event, Ended)):
                when = "first" if is_first else "again"
                self.falsified = f"the program's process sent the message {event.kind}, which must not come {when}"
        return None if self.falsified else event


def list_allowed_events(options: RunOptions, *, plugs: bool) -> _Kinds:
    """Return the classes of events that a run can send besides its start, its sounds and its end.

    Args:
        options: The options of the run.
        plugs: Whether parts may be plugged in.
    """
    return (
        *((Plugged,) if plugs else ()),
        *(DEBUGGED if options.can_pause else ()),
        *((InputWanted,) if options.asks_user else ()),
        *((ReplyWanted,) if options.replies else ()),
    )
