"""What is told, in which order, and in which parts."""

from __future__ import annotations

from math import inf

import pytest
from textual.app import ComposeResult
from textual.geometry import Region
from textual.widgets import Static

from tests.app.app_help import notices, until
from tuisim.app import notices as module
from tuisim.app.notices import NoticeRow, split_message
from tuisim.app.terminal_app import TerminalApp

LONG = "words of an error that names a file and a key, and says what is allowed"


@pytest.mark.parametrize("columns, count", [(20, 6), (40, 3), (70, 2), (71, 1), (200, 1)])
def test_a_message_is_shown_whole_in_as_few_parts_as_it_needs(columns: int, count: int) -> None:
    parts = split_message(LONG, columns)
    assert all(len(part) <= columns and "\n" not in part for part in parts)
    assert len(parts) == count
    if len(parts) > 1:
        assert [part.partition(" ")[0] for part in parts] == [
            f"{at}/{count}" for at in range(1, count + 1)
        ]
        parts = [part.partition(" ")[2] for part in parts]
    assert " ".join(" ".join(part.removesuffix(" …") for part in parts).split()) == LONG
    assert all(part.endswith(" …") for part in parts[:-1])


def test_lines_become_one() -> None:
    assert split_message("one\n  two", 40) == ["one two"]


async def test_an_answer_begins_anew_until_it_is_released(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "_MIN_PART_S", 0.0)
    monkeypatch.setattr(module, "CHARACTERS_A_SECOND", 1e6)
    app = TerminalApp()
    async with app.run_test(notifications=True, size=(60, 20)) as pilot:
        shown: list[str] = []
        monkeypatch.setattr(NoticeRow, "update", lambda _, part: shown.append(part[:3]))
        app.notify(LONG, timeout=inf)
        await until(pilot, lambda: shown[:3] == ["1/2", "2/2", "1/2"])
        assert app.query_one(NoticeRow).is_read
        app.notices.release()
        await until(pilot, lambda: not app.query(NoticeRow))


class _Lab(TerminalApp):
    """Panels, and the row of the keys."""

    CSS = "#panels { height: 1fr; } #keys { dock: bottom; height: 1; }"

    def compose(self) -> ComposeResult:
        yield Static(id="panels")
        yield Static(id="keys")


async def test_a_long_answer_moves_no_panel_and_covers_only_their_lower_border() -> None:
    app = _Lab()
    async with app.run_test(notifications=True, size=(60, 20)) as pilot:
        app.notify(LONG, timeout=inf)
        await until(pilot, lambda: any(row.region for row in app.query(NoticeRow)))
        assert app.query_one(NoticeRow).region == Region(0, 18, 60, 1)
        assert app.query_one("#panels").region.bottom == app.query_one("#keys").region.y == 19


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
