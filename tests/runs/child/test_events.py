"""What comes from a child that is no event."""

from __future__ import annotations

import pytest

from tuisim.errors import HostError
from tuisim.runs.child.events import decode_event


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
def test_rubbish_from_the_child_is_a_host_error(line: bytes) -> None:
    with pytest.raises(HostError):
        decode_event(line)
