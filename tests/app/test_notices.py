"""What is told, in which order, and in which parts."""

from __future__ import annotations

from math import inf

import pytest
from textual.app import ComposeResult
from textual.widgets import Static

from tests.app.app_help import notices, until
from tuisim.app.notices import NoticeRow, split_message
from tuisim.app.terminal_app import TerminalApp

LONG = "words of an error that names a file and a key, and says what is allowed"


@pytest.mark.parametrize(
    "columns, count, tallest", [(20, 2, 3), (40, 1, 2), (71, 1, 1), (200, 1, 1)]
)
def test_a_message_is_shown_whole_in_as_few_parts_as_it_needs(
    columns: int, count: int, tallest: int
) -> None:
    parts = split_message(LONG, columns)
    rows = [part.splitlines() for part in parts]
    assert all(len(part) <= 3 and max(map(len, part)) <= columns for part in rows)
    assert (len(parts), len(rows[0])) == (count, tallest)
    if len(parts) > 1:
        assert [part.partition(" ")[0] for part in parts] == [
            f"{at}/{count}" for at in range(1, count + 1)
        ]
        parts = [part.partition(" ")[2] for part in parts]
    assert " ".join(" ".join(part.removesuffix(" …") for part in parts).split()) == LONG
    assert all(part.endswith(" …") for part in parts[:-1])


def test_lines_become_one() -> None:
    assert split_message("one\n  two", 40) == ["one two"]


async def test_an_answer_stays_below_until_it_is_released() -> None:
    app = TerminalApp()
    async with app.run_test(notifications=True, size=(60, 20)) as pilot:
        app.notify(LONG, timeout=inf)
        await until(pilot, lambda: bool(app.query(NoticeRow)) and app.query_one(NoticeRow).is_read)
        row = app.query_one(NoticeRow)
        await until(pilot, lambda: row.region.height == 2)
        # The row of the keys is below it.
        assert row.region.bottom == 19
        app.notices.release()
        await until(pilot, lambda: not app.query(NoticeRow))


class _Lab(TerminalApp):
    """Panels, and the row of the keys."""

    CSS = "#panels { height: 1fr; } #keys { dock: bottom; height: 1; }"

    def compose(self) -> ComposeResult:
        yield Static(id="panels")
        yield Static(id="keys")


async def test_an_answer_of_several_rows_covers_no_panel() -> None:
    app = _Lab()
    async with app.run_test(notifications=True, size=(60, 20)) as pilot:
        app.notify(LONG, timeout=inf)
        panels = app.query_one("#panels")
        await until(pilot, lambda: panels.region.bottom == 17)
        assert app.query_one(NoticeRow).region.bottom == app.query_one("#keys").region.y == 19
        app.notices.release()
        await until(pilot, lambda: panels.region.bottom == 19)


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
