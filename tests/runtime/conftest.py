"""Real runs in real child processes."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import pytest

from tuisim.core.geometry import Pose
from tuisim.core.profile import PROFILES
from tuisim.core.spec import NoiseSpec, PenSpec, RobotSpec, RunSpec, WorldSpec
from tuisim.host import Program, RunHandle, RunOptions, start_run
from tuisim.protocol import Ended

FILE = "program.py"


@dataclass(frozen=True)
class Done:
    """A run that is over."""

    run: RunHandle
    ended: Ended

    @property
    def lines(self) -> list[str]:
        """What was printed, without error text."""
        return [row.text for row in self.run.output.all_rows() if row.stream == 1]

    @property
    def errors(self) -> list[str]:
        """Lines of error text."""
        return [row.text for row in self.run.output.all_rows() if row.stream == 2]

    @property
    def recording(self) -> tuple[bytes, bytes]:
        """Everything the run recorded, as bytes."""
        return tuple((self.run.folder / name).read_bytes() for name in ("telemetry.bin", "output.bin"))  # type: ignore[return-value]


Start = Callable[..., RunHandle]


@pytest.fixture
def start() -> Iterator[Start]:
    """`start(text, …)`: start a program; whatever still runs at the end of the test is killed."""
    handles: list[RunHandle] = []

    def begin(
        text: str,
        *,
        profile: str = "robolab",
        pose: tuple[float, float, float] = (150.0, 500.0, 0.0),
        noise: tuple[int, int] = (0, 0),
        seed: int = 0,
        prelude: str = "preloaded",
        background: str = "Grey_bands",
        pen: PenSpec | None = None,
        pen_marks: bool = False,
        solid: bool = False,
        **options: Any,
    ) -> RunHandle:
        world = WorldSpec(
            background=background, start=Pose(*pose), noise=NoiseSpec(*noise), pen_marks=pen_marks, solid=solid
        )
        spec = RunSpec(RobotSpec(pen=pen or PenSpec()), world, PROFILES[profile], seed)
        options.setdefault("time_limit_s", 20.0)
        handle = start_run(Program(FILE, text, prelude), spec, RunOptions(**options))
        handles.append(handle)
        return handle

    yield begin
    for handle in handles:
        handle.close()


@pytest.fixture
def run(start: Start) -> Callable[..., Done]:
    """`run(text, …)`: run a program to its end."""

    def finish(text: str, **how: Any) -> Done:
        handle = start(text, **how)
        ended = handle.wait(60.0)
        assert ended is not None
        return Done(handle, ended)

    return finish
