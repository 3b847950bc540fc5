"""The child's ends of the pipes: commands arrive, and events are sent."""

from __future__ import annotations

import os

from tuisim.engine.protocol import Message, parse_command
from tuisim.engine.runtime import wallclock


class Channel:
    """The child's ends of two pipes to the host, the process that has started the run.

    It receives commands without blocking, and sends events immediately.

    Args:
        command_fd: Read end of the command pipe.
        event_fd: Write end of the event pipe.
    """

    def __init__(self, command_fd: int, event_fd: int) -> None:
        self.command_fd, self._event_fd = command_fd, event_fd
        os.set_blocking(command_fd, False)
        self._rest = b""

    def send(self, event: Message) -> None:
        """Send an event to the host, the process that has started the run; do nothing if the host has ended."""
        data = event.encode()
        try:
            while data:
                data = data[os.write(self._event_fd, data) :]
        except BrokenPipeError:
            pass

    def receive(self) -> list[Message]:
        """Return the commands that have arrived, without blocking."""
        try:
            data = os.read(self.command_fd, 65536)
        except BlockingIOError:
            return []
        *lines, self._rest = (self._rest + data).split(b"\n")
        return [parse_command(line) for line in lines]

    def wait(self, timeout_s: float) -> bool:
        """Block until a command arrives, for at most `timeout_s` of real time; return whether one has arrived."""
        return bool(wallclock.select_files([self.command_fd], [], [], max(0.0, timeout_s))[0])
