"""Work in a thread: what comes back to the app, and what does not."""

from __future__ import annotations

from collections.abc import Callable
from threading import Event

import pytest
from textual.app import App

from tests.running import PATIENCE_S
from tuisim.app import background
from tuisim.errors import TuisimError


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


def nothing(app: App[None]) -> None:
    pass


def cancel(app: App[None]) -> None:
    app.workers.cancel_all()


@pytest.mark.parametrize(
    ("work", "before_the_end", "heard"),
    [
        pytest.param(succeed, nothing, ["done"], id="result"),
        pytest.param(fail, nothing, ["failed"], id="error"),
        pytest.param(succeed, cancel, ["done"], id="result-cancelled"),
        pytest.param(fail, cancel, [], id="error-cancelled"),
        pytest.param(succeed, App.exit, [], id="result-leaving"),
        pytest.param(fail, App.exit, [], id="error-leaving"),
    ],
)
async def test_work_passes_on(
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
