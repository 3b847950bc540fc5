"""The dialog that opens programs: a path can be typed at once."""

from __future__ import annotations

from pathlib import Path

import pytest
from textual.app import App
from textual.widgets import Input, OptionList, Static

from tuisim.app.dialogs.chooser import (
    ChoiceGroup,
    Chooser,
    build_program_chooser,
    list_files,
)
from tuisim.app.notices import NoticeRow
from tuisim.app.terminal_app import TerminalApp
from tuisim.base.errors import ConfigError

GROUPS = [
    ChoiceGroup("Here", [("/x/mine.py", "mine.py", "")]),
    ChoiceGroup(
        "Examples",
        [("/e/data_log.py", "data_log.py", "second"), ("/e/log.py", "log.py", "a log of greys")],
    ),
]


def no_file(word: str) -> None:
    if not word.startswith("/"):
        raise ConfigError(
            "there is no such program", "see `tuisim programs` for examples", file=word
        )


@pytest.mark.parametrize(
    "typed, listed, result",
    [
        ("log", ["data_log.py", "log.py"], "/e/log.py"),
        ("log sec", ["data_log.py"], "/e/data_log.py"),
        ("/f/other.py", [], "/f/other.py"),
        ("nope", [], None),
    ],
    ids=["name", "words", "path", "nothing"],
)
async def test_typing_in_a_chooser_searches_its_list_or_gives_a_path(
    typed: str, listed: list[str], result: str | None
) -> None:
    chosen: list[str | None] = []
    app: App[None] = App()
    async with app.run_test() as pilot:
        app.push_screen(Chooser("Open", GROUPS, path_hint="path", read=no_file), chosen.append)
        await pilot.pause()
        rows = app.screen.query_one(OptionList).size.height
        await pilot.press(*typed)
        await pilot.pause()
        dialog = app.screen
        values = [option.id for option in dialog.query_one(OptionList).options if option.id]
        assert [Path(value).name for value in values] == listed
        # It keeps its place.
        assert dialog.query_one(OptionList).size.height == rows
        await pilot.press("enter")
        await pilot.pause()
        assert chosen == ([result] if result else [])
        if not result:
            assert app.screen is dialog
            assert dialog.query_one(Input).value == typed
            assert (
                str(dialog.query_one("#message", Static).content)
                == f"{typed}: there is no such program"
            )


async def test_tab_completes_a_path_and_enter_looks_into_a_folder(tmp_path: Path) -> None:
    (tmp_path / "robots" / "deep").mkdir(parents=True)
    (tmp_path / "robots" / "deep" / "mine.py").write_text("")
    chosen: list[str | None] = []
    app: App[None] = App()
    async with app.run_test() as pilot:
        app.push_screen(
            Chooser("Open", GROUPS, path_hint="path", read=no_file, suffixes=[".py"]), chosen.append
        )
        await pilot.pause()
        await pilot.press("/")
        field = app.screen.query_one(Input)
        listed = app.screen.query_one(OptionList)
        field.value = f"{tmp_path}/ro"
        await pilot.press("tab")
        assert field.value == f"{tmp_path}/robots/"
        await pilot.pause()
        assert [option.id for option in listed.options if option.id] == [f"{tmp_path}/robots/deep/"]
        listed.action_select()
        await pilot.pause()
        assert (field.value, field.has_focus, chosen) == (f"{tmp_path}/robots/deep/", True, [])
        listed.action_select()
        await pilot.pause()
        assert chosen == [f"{tmp_path}/robots/deep/mine.py"]


async def test_tab_says_when_several_names_go_on_in_other_ways(tmp_path: Path) -> None:
    (tmp_path / "mine.py").write_text("")
    (tmp_path / "minor.py").write_text("")
    app: App[None] = App()
    async with app.run_test() as pilot:
        app.push_screen(Chooser("Open", GROUPS, path_hint="path", read=no_file, suffixes=[".py"]))
        await pilot.pause()
        await pilot.press("/")
        field = app.screen.query_one(Input)
        message = app.screen.query_one("#message", Static)
        field.value = f"{tmp_path}/m"
        await pilot.press("tab")
        assert (field.value, str(message.content)) == (f"{tmp_path}/min", "")
        await pilot.press("tab")
        assert str(message.content).startswith("2 names begin like this")
        await pilot.press("e")
        await pilot.pause()
        assert str(message.content) == ""


async def test_typing_a_path_that_does_not_exist_says_so_at_once() -> None:
    app: App[None] = App()
    async with app.run_test() as pilot:
        app.push_screen(Chooser("Open", GROUPS, path_hint="path", read=no_file, suffixes=[".py"]))
        await pilot.pause()
        await pilot.press(*"/no/such")
        await pilot.pause()
        assert str(app.screen.query_one("#message", Static).content) == "no such file here"


async def test_the_arrows_move_in_the_list_while_one_types() -> None:
    chosen: list[str | None] = []
    app: App[None] = App()
    async with app.run_test() as pilot:
        app.push_screen(Chooser("Open", GROUPS, path_hint="path", read=no_file), chosen.append)
        await pilot.pause()
        await pilot.press(*"log", "up", "enter")
        await pilot.pause()
    assert chosen == ["/e/data_log.py"]


async def test_enter_without_typing_chooses_the_selected_row() -> None:
    chosen: list[str | None] = []
    app: App[None] = App()
    async with app.run_test() as pilot:
        app.push_screen(
            Chooser("Open", [ChoiceGroup("", [("a.py", "a.py", "first")])], path_hint="path"),
            chosen.append,
        )
        await pilot.pause()
        assert not app.screen.query_one(Input).has_focus
        await pilot.press("down", "enter")
        await pilot.pause()
    assert chosen == ["a.py"]


def test_the_second_file_of_an_export_is_not_listed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for name in ("robot.json", "log.csv", "log.csv.json", "my.robot.json"):
        Path(name).touch()
    assert [name for _, name, _ in list_files([".json"]).entries] == ["my.robot.json", "robot.json"]


async def test_an_earlier_notice_covers_no_row_of_a_chooser() -> None:
    app = TerminalApp()
    async with app.run_test(notifications=True) as pilot:
        app.notify("said before")
        await pilot.pause()
        app.push_screen(Chooser("Open", [ChoiceGroup("", [("a.py", "a.py", "first")])]))
        await pilot.pause()
        assert not [row for screen in app.screen_stack for row in screen.query(NoticeRow)]


async def test_a_choosers_group_of_short_names_gives_the_room_to_titles() -> None:
    long_name = "a name as long as those of lessons are"
    groups = [
        ChoiceGroup("Here", [("skip", "Skip", "leaves one step undone")]),
        ChoiceGroup("All", [("one", long_name, "new")]),
    ]
    app: App[None] = App()
    async with app.run_test(size=(80, 24)) as pilot:
        app.push_screen(Chooser("Lessons", groups))
        await pilot.pause()
        rows = [strip.text for strip in app.screen._compositor.render_strips()]
        assert any("Skip  leaves one step undone" in row for row in rows)
        assert any(f"{long_name}  new" in row for row in rows)


def test_a_text_without_numbers_is_not_listed_as_a_log(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    texts = {
        "printed.txt": "Start\nColour: 100.0\nColour: 86.3\n",
        "stamped.log": "[0.1] Grey: 5\n[0.2] Grey: 6\n",
        "table.txt": "time;light\n0,1;50\n0,2;51\n",
        "measured.csv": "a,b\n",
        "shopping.txt": "Milk\nBread\n",
        "requirements.txt": "textual==8.0.1\nnumpy>=2\n",
        "empty.txt": "",
    }
    for name, text in texts.items():
        (tmp_path / name).write_text(text)
    monkeypatch.chdir(tmp_path)

    logs = next(group for group in build_program_chooser()._groups if group.title == "Logs")

    assert [name for _, name, _ in logs.entries] == [
        "measured.csv",
        "printed.txt",
        "stamped.log",
        "table.txt",
    ]
