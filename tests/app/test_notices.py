"""What is told, in which order, and where."""

from __future__ import annotations

from math import inf

import pytest
from textual.app import ComposeResult
from textual.containers import Horizontal, Vertical
from textual.geometry import Region
from textual.widgets import Static

from tests.app.app_help import notices, screen_text, until
from tuisim.app import notices as module
from tuisim.app.notices import NoticeRow
from tuisim.app.terminal_app import TerminalApp

LONG = "words of an error that names a file and a key, and says what is allowed"


async def test_a_long_notice_stays_whole_until_it_is_released(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(module, "CHARACTERS_A_SECOND", 1e6)
    app = TerminalApp()
    async with app.run_test(notifications=True, size=(60, 20)) as pilot:
        app.notify(LONG, timeout=inf)
        await until(pilot, lambda: any(row.is_read for row in app.query(NoticeRow)))
        assert " ".join(screen_text(app).replace("▌", "").split()) == LONG
        app.notices.release()
        await until(pilot, lambda: not app.query(NoticeRow))


class _Lab(TerminalApp):
    """Panels, and the row of the keys."""

    CSS = "Horizontal, .panel { height: 1fr; } .panel { width: 1fr; } #keys { dock: bottom; height: 1; }"

    def compose(self) -> ComposeResult:
        with Vertical():
            yield Static(classes="panel")
            with Horizontal():
                yield Static(classes="panel")
                yield Static(classes="panel")
        yield Static(id="keys")


async def test_a_long_notice_is_placed_on_the_border_between_upper_and_lower_panels() -> None:
    app = _Lab()
    async with app.run_test(notifications=True, size=(60, 21)) as pilot:

        async def wait_for_region(*numbers: int) -> None:
            regions = [Region(*numbers)]
            await until(pilot, lambda: [row.region for row in app.query(NoticeRow)] == regions)

        app.notify(LONG, timeout=inf)
        await wait_for_region(0, 9, 60, 2)
        app.notify("short", timeout=inf)
        await wait_for_region(0, 19, 60, 1)
        app.notify(LONG, timeout=inf)
        await wait_for_region(0, 9, 60, 2)
        app.query(".panel").first().display = False
        app.notices.follow_panels()
        await wait_for_region(0, 18, 60, 2)


async def test_a_notice_that_is_gone_before_the_panels_are_drawn_is_not_placed() -> None:
    app = _Lab()
    async with app.run_test(notifications=True) as pilot:
        app.notify(LONG, timeout=inf)
        await until(pilot, lambda: bool(app.query(NoticeRow)))
        row = app.query_one(NoticeRow)
        await row.remove()
        app.notices.clear()
        row.place()

        app.notify(LONG, timeout=inf)
        await until(pilot, lambda: bool(app.query(NoticeRow)))
        app.notices.follow_panels()
        app.notices.release()
        await until(pilot, lambda: not app.query(NoticeRow))
        await pilot.pause()


async def test_an_error_stays_until_it_is_read_and_the_newest_notice_follows() -> None:
    app = TerminalApp()
    async with app.run_test(notifications=True) as pilot:
        app.notify("wrong", severity="error", timeout=8)
        app.notify("first")
        app.notify("second [not markup]")
        await until(
            pilot, lambda: [row.notice.message for row in app.query(NoticeRow)] == ["wrong"]
        )
        assert notices(app) == ["wrong", "first", "second [not markup]"]
        await pilot.click(NoticeRow)
        await until(
            pilot,
            lambda: [row.notice.message for row in app.query(NoticeRow)] == ["second [not markup]"],
        )
        app.clear_notifications()
        await until(pilot, lambda: not app.query(NoticeRow))
        assert notices(app) == []
