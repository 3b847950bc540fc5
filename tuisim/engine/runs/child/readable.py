"""Waiting for a descriptor, whatever its number: `select.select` takes none from 1024 on."""

from __future__ import annotations

import select


def is_readable(descriptor: int, timeout_s: float | None) -> bool:
    """Return whether a descriptor can be read without blocking, or is at its end.

    Args:
        timeout_s: How long to wait until it can be; None waits without a limit.

    Raises:
        OSError: the descriptor is closed.
    """
    poll = select.poll()
    poll.register(descriptor, select.POLLIN)
    events = poll.poll(None if timeout_s is None else max(0, round(timeout_s * 1000)))
    if events and events[0][1] & select.POLLNVAL:
        raise OSError(9, "Bad file descriptor")
    return bool(events)
