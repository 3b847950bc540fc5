"""What comes from a child that is no event."""

from __future__ import annotations

import os

import pytest

from tests.cases import for_rows
from tuisim.base.errors import HostError
from tuisim.engine.protocol import (
    PROTOCOL_VERSION,
    End,
    Ended,
    InputWanted,
    Message,
    Spoke,
    Started,
)
from tuisim.engine.runs.child.events import EventStream, decode_event


@pytest.mark.parametrize(
    "line",
    [
        b"rubbish",
        b"[]",
        b'{"kind":"ended"}',
        b'{"kind":"nonsense"}',
        b'{"kind":"spoke","text":1,"time_ns":2}',
        b"\xff\xfe",
    ],
    ids=["text", "list", "missing", "unknown", "type", "bytes"],
)
def test_an_unreadable_event_from_a_programs_process_is_a_host_error(line: bytes) -> None:
    with pytest.raises(HostError):
        decode_event(line)


STARTED, SPOKE, ENDED = Started(PROTOCOL_VERSION, 7), Spoke("x", 5), Ended(End.FINISHED, 9, 10)


@for_rows(
    "events, count, says",
    [
        ([STARTED, SPOKE, SPOKE, ENDED], 4, ""),
        ([ENDED], 1, ""),
        ([SPOKE], 0, "sent the message spoke, which must not come first"),
        ([STARTED, STARTED], 1, "sent the message started, which must not come again"),
        ([STARTED, ENDED, SPOKE], 2, "sent the message spoke, which must not come here"),
        (
            [STARTED, InputWanted("?")],
            1,
            "sent the message input_wanted, which must not come here",
        ),
        ([Started(PROTOCOL_VERSION + 1, 7)], 0, "speaks protocol"),
        ([STARTED, Spoke("x", -(1 << 53)), SPOKE], 1, "sent an invalid message"),
    ],
)
def test_events_of_a_process_out_of_order_count_as_falsified(
    events: list[Message], count: int, says: str
) -> None:
    read_fd, write_fd = os.pipe()
    os.set_blocking(read_fd, False)
    try:
        stream = EventStream(read_fd, ())
        os.write(write_fd, b"".join(event.encode() for event in events))
        assert stream.read() == events[:count]
        assert says in stream.falsified and bool(says) == bool(stream.falsified)
        assert not stream.at_end
    finally:
        os.close(write_fd)
    more = stream.read()
    assert (more, stream.at_end) == ([], not says)
    os.close(read_fd)
