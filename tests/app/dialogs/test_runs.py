"""Stored runs in the app: opened, looked back at, run anew, also when mat or program are gone."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from textual.widgets import Input, OptionList, Static

from tests.app.app_help import (
    LOGS,
    notices,
    open_lab,
    program,
    program_of,
    screen_text,
    until,
    until_shown,
    until_state,
)
from tests.cases import cases, for_rows
from tests.conftest import Command
from tests.running import PATIENCE_S
from tuisim.app.app import AppSettings
from tuisim.app.dialogs.runs import (
    Differences,
    RunChooser,
    RunsChooser,
    build_header,
    find_likeliest,
    find_runs,
    run_line,
)
from tuisim.app.snapshot import RunPhase
from tuisim.app.terminal_app import TerminalApp
from tuisim.engine.protocol import End, SetNoise, UserAction
from tuisim.engine.runs.catalogue import RunInfo
from tuisim.engine.runs.diff import RunDiff, TickDifference
from tuisim.engine.runs.handle import RunOptions, start_run
from tuisim.engine.runs.store import RunStore
from tuisim.settings.build import build_run_spec
from tuisim.settings.command_line import Arguments
from tuisim.settings.options import Settings
from tuisim.terminal.cell_view import PixelView


def stored(text: str = LOGS, **choices: Any) -> str:
    """Carry a program out and return the run's id."""
    spec = build_run_spec(Settings({"background": "Grey_bands", "seed": 5, **choices}))
    options = RunOptions(
        actions=(UserAction(100, SetNoise(20, 0)), UserAction(200, SetNoise(0, 0)))
    )
    run = start_run(program(text), spec, options)
    assert run.wait(PATIENCE_S)
    return run.run_id


def replaying(run_id: str) -> AppSettings:
    run = RunStore().load_run(run_id)
    return AppSettings(spec=run.spec, replay=run, program=program(run.program.text))


@pytest.mark.slow
async def test_a_stored_run_is_shown_as_it_was_and_run_anew_alike() -> None:
    run_id = stored()
    async with open_lab(replaying(run_id)) as (pilot, app):
        await until(
            pilot,
            lambda: (
                app.run_controller.state == RunPhase.ENDED and "finished at" in screen_text(app)
            ),
        )
        assert "Colour: " in screen_text(app)
        assert app.run_controller.run_id == run_id
        assert app.run_controller.next_run.spec == RunStore().load_run(run_id).spec
        await pilot.press("g")
        app.screen.query_one(Input).value = "1.5"
        await pilot.press("enter")
        await until(pilot, lambda: app.run_controller.build_snapshot().past)
        assert app.run_controller.build_snapshot().instant.noise.light == 20
        assert app.run_controller.build_snapshot().spec.seed == 5
        app.run_controller.timeline.go(50)
        assert app.run_controller.build_snapshot().instant.noise.light == 0
        app.run_controller.set_speed(0.0)
        await pilot.press("R", "r")
        await until(
            pilot,
            lambda: (
                app.run_controller.run_id != run_id and app.run_controller.state == RunPhase.ENDED
            ),
        )
        again = RunStore().load_run(app.run_controller.run_id)
        first = RunStore().load_run(run_id)
        assert again.program.text == first.program.text
        assert again.telemetry.array()[:100].tobytes() == first.telemetry.array()[:100].tobytes()


@pytest.mark.slow
async def test_a_run_is_searched_for_and_chosen() -> None:
    ids = [
        stored("print('A: 1')\n"),
        stored("tank_drive.on_for_seconds(50, 50, 1)\n", background="Lollipop"),
    ]
    async with open_lab(size=(80, 24)) as (pilot, app):
        await pilot.press("h")
        await until_shown(pilot, "2 of 2 runs")
        assert re.search(
            r" samples +│.* Grey_bands finished +0\.\d+ +1 ", screen_text(app), re.DOTALL
        )
        await pilot.press(*"grey_b")
        await until_shown(pilot, "1 of 2 runs")
        assert isinstance(app.screen, RunChooser)
        assert app.screen.query_one(OptionList).option_count == 1
        way = app.screen.query_one(PixelView)
        await until(pilot, lambda: way._strips != [])
        await pilot.press(*["backspace"] * 6, *"LOLLI", "enter")
        await until(pilot, lambda: app.run_controller.run_id == ids[1])
        await until(
            pilot,
            lambda: (
                app.run_controller.mat is not None and app.run_controller.mat.name == "Lollipop"
            ),
        )
        await pilot.press("comma")
        assert app.run_controller.build_snapshot().past


@pytest.mark.slow
async def test_keys_count_where_the_list_of_runs_is_too_low_for_a_path() -> None:
    stored("print('A: 1')\n")
    async with open_lab(size=(80, 16)) as (pilot, _):
        await pilot.press("h")
        await until_shown(pilot, "1 of 1 runs")
        await pilot.press("x")
        await until_shown(pilot, "0 of 1 runs")


@pytest.mark.slow
@pytest.mark.usefixtures("real_mats")
async def test_a_stored_run_opens_after_its_mat_and_program_were_deleted(tmp_path: Path) -> None:
    from PIL import Image

    own = tmp_path / "own.png"
    Image.new("RGB", (2362, 1143), (0, 200, 0)).save(own)
    run_id = stored("tank_drive.on_for_seconds(50, 50, 1)\n", background=str(own))
    own.unlink()
    folder = RunStore().folder(run_id)
    async with open_lab(replaying(run_id)) as (pilot, app):
        await until_state(pilot, RunPhase.ENDED)
        # The prepared mat is in the cache still.
        assert app.run_controller.build_snapshot().colors["left"].green > 150
        assert program_of(app).path == ""
        await pilot.press("R")
        await until(pilot, lambda: any("own.png" in notice for notice in notices(app)))
        assert app.run_controller.run_id == run_id
    for name in json.loads((folder / "run.json").read_text())["field"]["sums"]:
        Path(name[1]).unlink()
    async with open_lab(replaying(run_id)) as (pilot, app):
        await until_state(pilot, RunPhase.ENDED)
        await until(pilot, lambda: any("the mat of the run" in notice for notice in notices(app)))
        await pilot.press("less_than_sign")
        assert app.run_controller.build_snapshot().past
        assert not app.run_controller.build_snapshot().colors


def _no_run_file(folder: Path) -> str:
    (folder / "run.json").write_text("{")
    return "run.json"


def _other_format(folder: Path) -> str:
    data = json.loads((folder / "run.json").read_text())
    (folder / "run.json").write_text(json.dumps(data | {"format": 1}))
    return "stored by another version of tuisim"


@pytest.mark.quick_cases("format")
@pytest.mark.parametrize("damage", [_no_run_file, _other_format], ids=["file", "format"])
async def test_opening_a_damaged_run_shows_a_notice(damage: Callable[[Path], str]) -> None:
    run_id = stored("print('A: 1')\ntank_drive.on_for_seconds(50, 50, 1)\n")
    said = damage(RunStore().folder(run_id))
    async with open_lab() as (pilot, app):
        await pilot.press("h")
        await until_shown(pilot, "1 of 1 runs")
        await pilot.press("enter")
        await until(pilot, lambda: any(said in notice for notice in notices(app)))
        assert not app.run_controller.run_id


@pytest.mark.quick_cases("a mat too")
@pytest.mark.parametrize(
    "words, said",
    [
        (["--run", "99"], "no run '99'"),
        (["--run", "1", "prog.py"], "remove prog.py"),
        (["--run", "1", "-b", "Lollipop"], "remove background"),
        (["--run", "1", "--world", "lab.toml"], "remove lab.toml"),
    ],
    ids=["no such run", "a program too", "a mat too", "a world too"],
)
def test_open_refuses_wrong_words_in_one_line(tuisim: Command, words: list[str], said: str) -> None:
    done = tuisim("open", *words)
    assert done.returncode == 2
    assert said in done.stderr
    assert len(done.stderr.splitlines()) == 1


def info(number: int, **facts: Any) -> RunInfo:
    base = RunInfo(
        number,
        f"id{number}",
        "2026-01-02T03:04:05+00:00",
        "line.py",
        "Loop",
        "robolab",
        0,
        End.FINISHED,
    )
    return replace(base, **facts)


@cases(
    "columns, names",
    {
        "wide": (100, "run when program mat end s samples note"),
        "usual": (80, "run when program mat end s samples"),
        "tall": (65, "run when program end s"),
        "phone": (48, "run program end s"),
        "smallest": (40, "run program end"),
    },
)
def test_a_narrow_list_of_runs_leaves_out_columns(columns: int, names: str) -> None:
    line = run_line(info(1, program="a_long_name_of_a_program.py"), columns).plain
    assert build_header(columns).split() == names.split()
    assert len(line) == len(build_header(columns).removesuffix("  note")) <= columns - 10
    assert "finished" in line


@pytest.mark.parametrize(
    "facts, columns, end",
    [
        ({"end": End.STOPPED, "summary": "stopped"}, 100, "0"),
        ({"end": End.TIME_LIMIT, "summary": "stopped at the limit of 20 s"}, 100, "0"),
        ({"end": End.RAISED, "summary": "KeyError: 'a'"}, 100, "0  KeyError: 'a'"),
        ({"end": End.RAISED, "summary": "KeyError: 'a'"}, 99, "0"),
        ({"tags": "branch:3"}, 100, "0  branch:3"),
    ],
    ids=["the end only", "the limit", "an error", "no room", "tags"],
)
def test_the_list_of_runs_does_not_repeat_the_end_as_a_note(
    facts: dict[str, Any], columns: int, end: str
) -> None:
    assert run_line(info(1, **facts), columns).plain.partition("0.00       ")[2] == end


@for_rows(
    "search, numbers",
    [
        ("", [3, 2, 1]),
        ("line", [3, 1]),
        ("loop error", [2]),
        ("best", [3]),
        ("2026-01", [3, 2, 1]),
        ("none", []),
        ("1", [1, 3, 2]),
        ("3 1", [3, 1, 2]),
    ],
)
def test_a_search_for_runs_finds_words_in_any_column(search: str, numbers: list[int]) -> None:
    runs = [info(1), info(2, program="maze.py", end=End.RAISED), info(3, tags="best branch")]
    assert [run.number for run in find_runs(runs, search)] == numbers


def test_a_run_that_marked_a_student_names_the_student_at_80_columns() -> None:
    assert " ada/main.py " in run_line(info(1, program="main.py", tags="student:ada"), 80).plain


def test_replay_in_the_shell_prepares_the_stored_run_with_its_program() -> None:
    from tuisim.commands.resolve import NO_CONFIG, prepare_replay

    run_id = stored("print('A: 1')\n")
    run, prepared = prepare_replay(
        run_id, [], Arguments(world=None, settings={"rays": True}), NO_CONFIG
    )
    assert (run.id, prepared.settings["rays"]) == (run_id, True)
    assert prepared.program is not None
    assert prepared.program.text == "print('A: 1')\n"


LISTED = [
    info(7, program="other.py"),
    info(6, program="line.py"),
    info(5, program="line.py"),
    info(2, program="maze.py"),
]
LIKELIEST = {
    "the same program": (info(8, program="line.py"), 6),
    "a branch": (info(8, program="line.py", tags="branch-of-5 at-1.00s"), 5),
    "a branch of a run that is gone": (info(8, program="maze.py", tags="branch-of-1 at-1.00s"), 2),
    "a new program": (info(8, program="new.py"), 7),
}


@cases("this, number", LIKELIEST)
def test_the_run_proposed_for_a_comparison_is_the_likeliest_one(this: RunInfo, number: int) -> None:
    assert LISTED[find_likeliest(LISTED, this)].number == number


@pytest.mark.slow
async def test_the_list_of_runs_is_whole_also_after_a_resize(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    listed = [info(number) for number in range(1, 13)]
    monkeypatch.setattr("tuisim.app.dialogs.runs._load_runs", lambda: listed)
    async with open_lab("x = 1\n", size=(80, 24)) as (pilot, app):
        dialog = RunChooser()
        await app.push_screen(dialog)
        await until(pilot, lambda: dialog.query_one(OptionList).option_count == 12)
        for size in ((80, 24), (65, 58), (120, 40)):
            await pilot.press("down")
            highlighted = dialog.query_one(OptionList).highlighted
            await pilot.resize_terminal(*size)
            await pilot.pause()
            frame = dialog.query_one(".dialog").content_region
            assert frame.contains_region(dialog.query_one(PixelView).region)
            heads = dialog.query_one(".heads", Static)
            assert str(heads.render()).split() == build_header(size[0]).split()
            assert dialog.query_one(OptionList).highlighted == highlighted


@cases(
    "keys, chosen",
    {
        "a number comes first": ("4 enter", "id4"),
        "the row that is highlighted": ("4 down enter", "id45"),
        "several numbers": ("4 space 1 2 enter", "id4 id12"),
        "a space in the list marks": ("4 down space space enter", "id45 id44"),
        "words go on after the list": ("4 down backspace 1 2 enter", "id12"),
    },
)
async def test_enter_opens_what_the_list_of_runs_shows(
    keys: str, chosen: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    listed = [info(number) for number in range(1, 46)]
    monkeypatch.setattr("tuisim.app.dialogs.runs._load_runs", lambda: listed)
    monkeypatch.setattr(RunChooser, "_draw_way", lambda _: None)
    results: list[str | None] = []
    app = TerminalApp()
    async with app.run_test(size=(120, 40)) as pilot:
        dialog = RunsChooser()
        await app.push_screen(dialog, results.append)
        await until(pilot, lambda: dialog.query_one(OptionList).option_count == 45)
        frame = dialog.query_one(".dialog")
        await until(pilot, lambda: "· space marks several" in str(frame.border_subtitle))
        await pilot.press("4")
        await until(pilot, lambda: "· ↓, then space marks several" in str(frame.border_subtitle))
        await pilot.press(*keys.split()[1:])
        await until(pilot, lambda: bool(results))
        assert results == [chosen]


async def test_the_run_proposed_for_a_comparison_is_in_view_below_many_newer_ones(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    listed = [info(1, program="rare.py"), *(info(number) for number in range(2, 80))]
    this = info(80, program="rare.py")
    monkeypatch.setattr("tuisim.app.dialogs.runs._load_runs", lambda: [*listed, this])
    monkeypatch.setattr(RunChooser, "_draw_way", lambda _: None)
    app = TerminalApp()
    async with app.run_test(size=(120, 40)) as pilot:
        dialog = RunChooser()
        dialog._left_out = this.id
        await app.push_screen(dialog)
        options = dialog.query_one(OptionList)
        await until(pilot, lambda: options.highlighted == len(listed) - 1)
        await until(pilot, lambda: options.scroll_y > 0)
        assert options.scroll_y == options.max_scroll_y


@cases(
    "tick, keys",
    {
        "none": (None, {"esc": "close"}),
        "one": (TickDifference(3, 0.03, ("x_mm",)), {"enter": "go", "esc": "close"}),
    },
)
async def test_the_differences_offer_to_go_only_to_a_difference(
    tick: TickDifference | None, keys: dict[str, str]
) -> None:
    app = TerminalApp()
    async with app.run_test(size=(120, 40)):
        dialog = Differences("Run 1", "run 2", RunDiff((), (), False, tick, None, None, None, None))
        await app.push_screen(dialog)
        assert dict(dialog.keys) == keys
