"""Work in a thread: what comes back to the app, and what does not."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from threading import Event, Thread

import pytest
from textual.app import App

from tests.cases import cases
from tests.running import PATIENCE_S
from tuisim.app import background
from tuisim.base.atomic import replacing
from tuisim.base.errors import TuisimError


def succeed(may_end: Event) -> str:
    assert may_end.wait(PATIENCE_S)
    return "done"


def fail(may_end: Event) -> str:
    assert may_end.wait(PATIENCE_S)
    raise TuisimError("failed")


class Worker(App[None]):
    def __init__(self) -> None:
        super().__init__()
        self.heard: list[str] = []

    def complain(self, error: TuisimError) -> None:
        self.heard.append(str(error))


def nothing(_: object) -> None:
    pass


def cancel(app: App[None]) -> None:
    app.workers.cancel_all()


@cases(
    "work, before_the_end, heard",
    {
        "result": (succeed, nothing, ["done"]),
        "error": (fail, nothing, ["failed"]),
        "result-cancelled": (succeed, cancel, ["done"]),
        "error-cancelled": (fail, cancel, []),
        "result-leaving": (succeed, App.exit, []),
        "error-leaving": (fail, App.exit, []),
    },
)
async def test_results_and_errors_of_work_reach_the_app_unless_it_has_ended(
    work: Callable[[Event], str], before_the_end: Callable[[App[None]], None], heard: list[str]
) -> None:
    may_end, ended, app = Event(), Event(), Worker()

    def watched() -> str:
        try:
            return work(may_end)
        finally:
            ended.set()

    async with app.run_test() as pilot:
        background.run(app, watched, app.heard.append, app.complain)
        await pilot.pause()
        before_the_end(app)
        may_end.set()
        while not ended.is_set() or (heard and not app.heard):
            await pilot.pause()
    assert app.heard == heard


async def test_leaving_the_app_does_not_wait_for_background_work() -> None:
    may_end, began, app = Event(), Event(), Worker()

    def work() -> None:
        began.set()
        may_end.wait()

    async with app.run_test() as pilot:
        background.run(app, work, nothing)
        while not began.is_set():
            await pilot.pause()
        app.exit()
    # It is left by now; neither the loop of the app nor Python wait for this thread.
    working = [thread for thread in background._threads if thread.is_alive()]
    may_end.set()
    assert [thread.daemon for thread in working] == [True]


class LeftError(Exception):
    """Stands for the end of the process."""


@pytest.fixture
def work_that_writes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Iterator[tuple[Path, Event]]:
    """A file that a thread writes until it may go on."""
    began, may_end, path = Event(), Event(), tmp_path / "movie.gif"

    def write() -> None:
        # The file may have been dropped.
        with suppress(FileNotFoundError), replacing(path) as handle:
            handle.write(b"movie")
            began.set()
            may_end.wait()

    def leave(code: int) -> None:
        raise LeftError(code)

    thread = Thread(target=write, daemon=True)
    monkeypatch.setattr(background, "_threads", [thread])
    monkeypatch.setattr(os, "_exit", leave)
    thread.start()
    began.wait()
    yield path, may_end
    may_end.set()
    thread.join()


def test_a_file_that_is_nearly_written_is_finished_at_the_end(
    work_that_writes: tuple[Path, Event],
) -> None:
    path, may_end = work_that_writes
    may_end.set()
    assert background.leave(3) == 3
    assert path.read_bytes() == b"movie"


def test_a_file_not_written_in_time_at_the_end_is_dropped_and_named(
    work_that_writes: tuple[Path, Event],
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    path, _ = work_that_writes
    monkeypatch.setattr(background, "FINISHES_WITHIN_S", 0.0)
    with pytest.raises(LeftError, match="3"):
        background.leave(3)
    assert list(path.parent.iterdir()) == []
    assert f"{path} was not written" in capsys.readouterr().err


def test_leaving_an_app_without_background_work_keeps_its_exit_code(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(background, "_threads", [])
    assert background.leave(3) == 3
