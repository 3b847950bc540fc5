"""Drives a run that holds: send a command, wait for what comes of it."""

from __future__ import annotations

import time
from dataclasses import dataclass, field
from typing import TypeVar

from tests.running import PATIENCE_S
from tuisim.engine.protocol import (
    Ended,
    Inspect,
    Inspected,
    LineHistory,
    Message,
    Paused,
    RequestHistory,
)
from tuisim.engine.runs.handle import RunHandle

Kind = TypeVar("Kind", bound=Message)


@dataclass
class Driver:
    """The other end of a run that is debugged."""

    run: RunHandle
    events: list[Message] = field(default_factory=list)

    def wait_for(self, *kinds: type[Message]) -> Message:
        """Return the next event of these kinds; those before it are dropped."""
        give_up = time.monotonic() + PATIENCE_S
        while True:
            while self.events:
                event = self.events.pop(0)
                if isinstance(event, kinds):
                    return event
                assert not isinstance(event, Ended), event
            assert time.monotonic() < give_up, "it never came"
            self.run.wait_for_event(0.05)
            self.events += self.run.pump()

    def paused(self) -> Paused:
        """Wait until it holds."""
        event = self.wait_for(Paused)
        assert isinstance(event, Paused)
        return event

    def do(self, command: Message) -> Paused:
        """Send a command and wait until it holds."""
        self.run.send(command)
        return self.paused()

    def do_or_end(self, command: Message) -> Paused | Ended:
        """Send a command and wait until it holds or is over."""
        self.run.send(command)
        event = self.wait_for(Paused, Ended)
        assert isinstance(event, Paused | Ended)
        return event

    def look(self, *watches: str, thread: str = "", frame: int = 0) -> Inspected:
        """Look at the run."""
        self.run.send(Inspect(watches, thread, frame))
        event = self.wait_for(Inspected)
        assert isinstance(event, Inspected)
        return event

    def values(self, frame: int = 0) -> dict[str, str]:
        """Return the names of a frame with their texts."""
        return {variable.name: variable.value for variable in self.look(frame=frame).variables}

    def history(self, count: int = 100) -> LineHistory:
        """Return the lines that were met last."""
        self.run.send(RequestHistory(count))
        event = self.wait_for(LineHistory)
        assert isinstance(event, LineHistory)
        return event

    def finish(self, command: Message | None = None) -> Ended:
        """Send a command and wait for the end."""
        if command is not None:
            self.run.send(command)
        event = self.wait_for(Ended)
        assert isinstance(event, Ended)
        return event
