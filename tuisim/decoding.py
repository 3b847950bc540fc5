"""Events from the child, checked against their schema: rubbish is an error, never a crash."""

from __future__ import annotations

import msgspec

from tuisim.errors import HostError
from tuisim.protocol import EVENTS, Message


class _Envelope(msgspec.Struct):
    kind: str


def decode_event(line: bytes) -> Message:
    """Return the event in one line from the child.

    Raises:
        HostError: the line is not an event of this protocol.
    """
    try:
        kind = EVENTS[msgspec.json.decode(line, type=_Envelope).kind]
        return msgspec.json.decode(line, type=kind)
    except (msgspec.MsgspecError, UnicodeDecodeError, KeyError) as error:
        raise HostError(f"the program's process sent something that is no message: {line[:60]!r}") from error
