"""Events from the child, checked against their schema: rubbish is an error, never a crash."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from typing import Any

import msgspec

from tuisim.errors import HostError
from tuisim.protocol import EVENTS, Message


class _Envelope(msgspec.Struct):
    kind: str


_EVENT_FIELDS: Mapping[str, type[Any]] = {
    kind: msgspec.defstruct(
        f"{event.__name__}Fields",
        [(field.name, {"int": int, "str": str, "bool": bool}[str(field.type)]) for field in fields(event)],
    )
    for kind, event in EVENTS.items()
}


def decode_event(line: bytes) -> Message:
    """Return the event in one line from the child.

    Raises:
        HostError: the line is not an event of this protocol.
    """
    try:
        event = EVENTS[msgspec.json.decode(line, type=_Envelope).kind]
        values = msgspec.json.decode(line, type=_EVENT_FIELDS[event.kind])
    except (msgspec.MsgspecError, UnicodeDecodeError, KeyError) as error:
        raise HostError(f"the program's process sent something that is no message: {line[:60]!r}") from error
    return event(**msgspec.structs.asdict(values))
