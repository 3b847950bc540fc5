"""What is told, in which order, and where."""

from __future__ import annotations

from math import inf

import pytest
from textual.geometry import Region

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
        await until(pilot, lambda: " ".join(screen_text(app).replace("▌", "").split()) == LONG)
        app.notices.release()
        await until(pilot, lambda: not app.query(NoticeRow))


async def test_the_rows_that_a_notice_needs_are_left_free_until_it_is_gone() -> None:
    app = TerminalApp()
    rows: list[int] = []
    app.notices.leave_rows = rows.append
    async with app.run_test(notifications=True, size=(60, 21)) as pilot:
        app.notify(LONG, timeout=inf)
        await until(pilot, lambda: rows == [1])
        assert [row.region for row in app.query(NoticeRow)] == [Region(0, 18, 60, 2)]
        app.notices.release()
        await until(pilot, lambda: rows == [1, 0])


async def test_rows_are_not_taken_back_between_two_notices_that_need_as_many() -> None:
    app = TerminalApp()
    rows: list[int] = []
    app.notices.leave_rows = rows.append
    async with app.run_test(notifications=True, size=(60, 21)) as pilot:
        app.notify(LONG, timeout=inf)
        await until(pilot, lambda: rows == [1])
        app.notices.release()
        app.notify(LONG[::-1], timeout=inf)
        await until(pilot, lambda: rows == [1, 1])
        app.clear_notifications()
        await until(pilot, lambda: rows == [1, 1, 0])


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
