"""The analyser and its keys, on a real run."""

from __future__ import annotations

from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

import pandas as pd
import pytest
from textual.pilot import Pilot
from textual.widgets import Input, OptionList

from tests.app.app_help import LOGS, notices, open_lab, program, until
from tuisim.analysis.model import AnalysisModel
from tuisim.analysis.source import NOTES_FILE, LogRequest, read_notes
from tuisim.app.analyser.actions.keys import ACTIONS
from tuisim.app.analyser.app import Analyser, AnalyserApp
from tuisim.app.analyser.panes import PaneView
from tuisim.app.dialogs.palette import Palette
from tuisim.base.errors import LogError
from tuisim.engine.runs.handle import RunOptions, start_run
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.engine.runs.store import load_run
from tuisim.logs.frames import read_log
from tuisim.programs.program_file import parse_program
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings

SIZES = [(80, 24), (120, 40), (200, 60)]


@asynccontextmanager
async def open_analyser(
    size: tuple[int, int] = (120, 40), **log: Any
) -> AsyncIterator[tuple[Pilot[Any], Analyser, AnalysisModel]]:
    """Open the analyser with a log, asked for as in `LogRequest`, and wait until it is there."""
    async with AnalyserApp(LogRequest(**log)).run_test(size=size) as pilot:
        app = pilot.app
        await until(pilot, lambda: isinstance(app.screen, Analyser) and app.screen.is_open)
        screen = app.screen
        assert isinstance(screen, Analyser) and screen.is_open
        await pilot.pause()
        yield pilot, screen, screen.model


def text_of(pilot: Pilot[Any]) -> str:
    return "\n".join(
        "".join(part.text for part in strip)
        for strip in pilot.app.screen._compositor.render_strips()
    )


@pytest.mark.slow_cases("(200, 60)")
@pytest.mark.parametrize("size", SIZES, ids=str)
async def test_the_first_screen_of_the_analyser_shows_all_its_parts(
    run: StoredRun, size: tuple[int, int]
) -> None:
    async with open_analyser(runs=(run.id,), size=size) as (pilot, _, _):
        await until(pilot, lambda: "print('Colour" in text_of(pilot))
        text = text_of(pilot)
        assert all(
            word in text
            for word in ("Chart", "[x] Colour", "[Table]", "World", "variable", "? help")
        )
        assert ("Sensor arrays" in text) is (size[1] > 30)


async def test_on_a_high_narrow_screen_each_view_of_the_analyser_has_the_whole_width(
    run: StoredRun,
) -> None:
    async with open_analyser(runs=(run.id,), size=(64, 60)) as (pilot, screen, _):
        views = (screen.chart, screen.pane, screen.world)
        await until(pilot, lambda: all(view.region.width == 64 for view in views))
        assert screen.chart.region.y < screen.pane.region.y < screen.world.region.y


@pytest.mark.slow
async def test_keys_of_the_analyser_find_bands_and_write_notes_about_them(run: StoredRun) -> None:
    async with open_analyser(runs=(run.id,)) as (pilot, screen, model):
        await pilot.press("b", "down")
        text = text_of(pilot)
        assert "82.75 light grey" in text
        assert model.rows.text(model.row, "value") == "86.2745"
        await pilot.press("m")
        field = pilot.app.screen.query_one(Input)
        assert field.value == "band 2: 86.27 pale grey"
        # What is typed takes the place of what is proposed.
        await pilot.press(*"white", "enter")
        await pilot.press("n")
        assert "white" in text_of(pilot)
        (note,) = read_notes(run.folder / NOTES_FILE)
        assert (note.variable, note.text) == ("Colour", "white")
        assert note.start_s < model.find_time_s(model.row) < note.stop_s
        await pilot.press("home", "delete")
        assert not read_notes(run.folder / NOTES_FILE)
        assert screen.model is model


async def test_the_mouse_reads_the_chart_without_a_press(run: StoredRun) -> None:
    async with open_analyser(runs=(run.id,)) as (pilot, screen, model):
        before = model.row
        at_cursor = str(screen.chart.border_subtitle)
        await pilot.hover(screen.chart, offset=(40, 5))
        await until(pilot, lambda: str(screen.chart.border_subtitle) != at_cursor)
        assert " s  Colour " in str(screen.chart.border_subtitle)
        assert model.row == before
        await pilot.hover(screen.pane, offset=(5, 5))
        await until(pilot, lambda: str(screen.chart.border_subtitle) == at_cursor)


@pytest.mark.slow
async def test_a_long_note_goes_on_in_further_lines(run: StoredRun) -> None:
    words = " ".join(f"word{at}" for at in range(40))
    async with open_analyser(runs=(run.id,), size=(80, 30)) as (pilot, _, model):
        await typed(pilot, "m", f"={words}", "enter", "n")
        await until(pilot, lambda: "word39" in text_of(pilot))
        assert all(word in text_of(pilot) for word in words.split())
        await pilot.press("delete")
        assert not model.notes


async def test_tab_accepts_the_suggested_word_in_a_prompt_of_the_analyser(run: StoredRun) -> None:
    async with open_analyser(runs=(run.id,), size=(80, 24)) as (pilot, _, _):
        await pilot.press("d")
        await until(pilot, lambda: isinstance(pilot.app.focused, Input))
        field = pilot.app.screen.query_one(Input)
        await pilot.press("v", "=", "s", "l")
        await until(pilot, lambda: bool(field._suggestion))
        await pilot.press("tab")
        assert field.value == "v=slope("


@pytest.mark.slow
async def test_the_bands_as_shown_are_exported(run: StoredRun, tmp_path: Path) -> None:
    target = tmp_path / "bands.csv"
    async with open_analyser(runs=(run.id,)) as (pilot, _, model):
        await pilot.press("b")
        await until(pilot, lambda: bool(model.bands()))
        await typed(pilot, "e", f"={target}", "enter")
        await until(pilot, target.exists)
        frame = pd.read_csv(target)
        assert frame["level"].tolist() == pytest.approx([band.level for band in model.bands()])
        assert frame["variable"].unique().tolist() == ["Colour"]


@pytest.mark.parametrize(
    "size, words", [((80, 20), "row 2 of 8"), ((80, 24), "")], ids=["too many", "all fit"]
)
async def test_a_pane_tells_the_number_of_the_selected_row_if_not_all_rows_fit(
    run: StoredRun, size: tuple[int, int], words: str
) -> None:
    async with open_analyser(runs=(run.id,), size=size) as (pilot, screen, model):
        await pilot.press("b")
        await until(pilot, lambda: bool(model.bands()))
        await pilot.press("down")
        await pilot.pause()
        subtitle = screen.query_one(PaneView).border_subtitle or ""
        assert (words in subtitle) if words else not subtitle


@pytest.mark.slow
async def test_the_analyser_lists_stored_runs_and_opens_several_marked_ones(run: StoredRun) -> None:
    handle = start_run(
        program("print('Colour: 7')\n"), build_run_spec(Settings()), RunOptions(speed=0.0)
    )
    handle.wait()
    async with open_analyser(runs=(run.id,), size=(80, 24)) as (pilot, screen, _):
        await pilot.press("R")
        await until(pilot, lambda: pilot.app.screen is not screen and "prog.py" in text_of(pilot))
        await pilot.press("down", "up", "space", "space", "enter")
        await until(pilot, lambda: pilot.app.screen is screen and len(screen.request.runs) == 2)
        assert screen.request.runs[0] == handle.run_id
        await typed(pilot, "R")
        await until(pilot, lambda: pilot.app.screen is not screen and "prog.py" in text_of(pilot))
        await typed(pilot, f"={load_run(handle.run_id).number}", "tab")
        pilot.app.screen.query_one(Input).focus()
        await pilot.press("enter")
        await until(pilot, lambda: screen.request.runs == (handle.run_id,))


async def test_the_analysers_source_shows_a_magic_line_as_it_was_written() -> None:
    text = parse_program(
        "%%sim_magic_preloaded -b Grey_bands\nprint('Colour: 7')\n", "prog.py"
    ).program.text
    handle = start_run(program(text), build_run_spec(Settings()), RunOptions(speed=0.0))
    handle.wait()
    async with open_analyser(runs=(handle.run_id,)) as (pilot, _, _):
        await until(pilot, lambda: "%%sim_magic_preloaded -b Grey" in text_of(pilot))


@pytest.mark.slow
async def test_moving_the_cursor_moves_every_pane_of_the_analyser(run: StoredRun) -> None:
    async with open_analyser(runs=(run.id,)) as (pilot, _, model):
        await until(pilot, lambda: "print('Colour" in text_of(pilot))
        before = text_of(pilot)
        await pilot.press("end")
        assert model.row == model.log.rows - 1
        assert f"row {model.log.rows} of" in text_of(pilot)
        assert text_of(pilot) != before
        await pilot.press("left")
        assert model.row == model.log.rows - 2
        await typed(pilot, "g", "=2s", "enter")
        assert model.find_time_s(model.row) == pytest.approx(2.0, abs=0.06)
        await pilot.press("a", "shift+right")
        assert "Δt" in text_of(pilot)


async def typed(pilot: Pilot[Any], *keys: str) -> None:
    """Press keys; `=text` puts a text into the field that has been opened."""
    for key in keys:
        if key.startswith("="):
            pilot.app.screen.query_one(Input).value = key[1:]
        else:
            await pilot.press({"<": "less_than_sign", ">": "greater_than_sign"}.get(key, key))


def filtered(model: AnalysisModel) -> bool:
    return 0 < len(model.rows) < model.log.rows


STEPS: list[tuple[list[str], Callable[[Analyser, AnalysisModel], bool]]] = [
    (["z", "z", "right_square_bracket"], lambda _, model: model.limits is not None),
    (["f"], lambda _, model: model.limits is None),
    (["F", "=value<90", "enter"], lambda _, model: filtered(model)),
    (["U"], lambda _, model: len(model.rows) == model.log.rows),
    (
        [">", "o", "o"],
        lambda _, model: (
            (model.rows.view.sorted_by, model.rows.view.descending) == ("variable", True)
        ),
    ),
    (
        ["U", "slash", "=82.7", "enter"],
        lambda _, model: model.rows.text(model.row, "value").startswith("82.7"),
    ),
    (["space"], lambda _, model: not model.traces.list_ticked()),
    (
        ["space", "x", "X", "H"],
        lambda screen, _: screen.chart.options.facets and screen.chart.options.hold,
    ),
    (
        ["k", "=y_mm against x_mm", "enter"],
        lambda screen, _: screen.chart.options.against == ("x_mm", "y_mm"),
    ),
    (["k", "=", "enter"], lambda screen, _: screen.chart.options.against is None),
    (["A", "=distance", "enter"], lambda _, model: model.alignment == "distance"),
    (["home", ">", ">", "y"], lambda screen, _: screen.app.clipboard == "100"),
    (["ctrl+y"], lambda screen, model: screen.app.clipboard.count("\n") == model.log.rows),
    (["b", "ctrl+y"], lambda screen, _: "pale grey" in screen.app.clipboard),
    (["plus", "plus"], lambda screen, _: screen.pane.display and not screen.chart.display),
    (["plus"], lambda screen, _: screen.chart.display and screen.pane.display),
    (["w"], lambda screen, _: not screen.world.display),
]


@pytest.mark.slow
async def test_each_key_of_the_analyser_does_its_action(run: StoredRun) -> None:
    async with open_analyser(runs=(run.id,)) as (pilot, screen, model):
        for keys, so in STEPS:
            await typed(pilot, *keys)
            assert so(screen, model), keys


@pytest.mark.slow
async def test_no_action_of_the_analyser_fails_on_an_empty_log(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # A screenshot is saved where one is.
    monkeypatch.chdir(tmp_path)
    spec = build_run_spec(Settings())
    handle = start_run(program("print('no sample')"), spec, RunOptions(speed=0.0))
    handle.wait()
    async with open_analyser(runs=(handle.run_id,), size=(80, 24)) as (
        pilot,
        screen,
        _,
    ):
        # Without a sample, it opens with the telemetry.
        await until(pilot, lambda: " · telemetry" in text_of(pilot))
        await pilot.press("T")
        await until(pilot, lambda: "This log is empty. T shows the telemetry" in text_of(pilot))
        for name in ACTIONS:
            if name not in ("leave", "telemetry"):
                screen.action_act(name)
                if pilot.app.screen is not screen:
                    await pilot.pause()
                while pilot.app.screen is not screen:
                    await pilot.press("escape")


@pytest.mark.slow
async def test_the_analyser_reads_new_rows_of_a_growing_log_file(tmp_path: Path) -> None:
    file = tmp_path / "log.txt"
    file.write_text("Colour: 1\nColour: 2\n")
    async with open_analyser(file=str(file), size=(80, 24)) as (pilot, screen, model):
        await pilot.press("end", "d")
        with file.open("a") as handle:
            handle.write("Colour: 3\n")

        def has_grown() -> bool:
            screen.poll()
            return screen.is_open and screen.model.log.rows == 3

        await until(pilot, has_grown)
        assert screen.is_open and screen.model.row == 2
        assert screen.model is not model
        # What was asked about the shorter log holds for what there is of it now.
        await typed(pilot, "=v = Colour + 1", "enter")
        assert screen.model.log.series("v").values.tolist() == [2.0, 3.0, 4.0]


async def test_a_notice_says_once_how_a_log_file_was_read(tmp_path: Path) -> None:
    file = tmp_path / "log.txt"
    file.write_text("Colour: 5\nColour: 6\nEnd\n")
    async with open_analyser(file=str(file), size=(80, 24)) as (pilot, screen, _):
        await until(pilot, lambda: screen.model.opened.done)
        await pilot.pause()
        said = notices(pilot.app)
        assert said == [*screen.model.log.notes] == ["1 line is not a sample (line 3)"]


async def test_a_log_that_cannot_be_opened_ends_the_app_with_the_reason(tmp_path: Path) -> None:
    app = AnalyserApp(LogRequest(file=str(tmp_path / "none.csv")))
    async with app.run_test() as pilot:
        await until(pilot, lambda: app.failure is not None)
    assert isinstance(app.failure, LogError)


@pytest.mark.slow
async def test_a_key_pressed_in_the_analyser_does_not_reach_the_lab_below(run: StoredRun) -> None:
    async with open_lab(LOGS) as (pilot, lab):
        below, pose = lab.screen, lab.run_controller.build_snapshot().instant.pose
        analyser = Analyser(LogRequest(runs=(run.id,)))
        await lab.push_screen(analyser)
        await until(pilot, lambda: analyser.is_open)
        await pilot.press("d", "escape", "B", "i", "left", "shift+up")
        assert lab.screen is analyser
        assert lab.run_controller.build_snapshot().instant.pose == pose
        await pilot.press("ctrl+p")
        await until(pilot, lambda: isinstance(lab.screen, Palette))
        offered = lab.screen.query_one(OptionList).options
        assert {option.id for option in offered} <= ACTIONS.keys()
        await pilot.press("escape")
        await until(pilot, lambda: lab.screen is analyser)
        await pilot.press("q")
        await until(pilot, lambda: lab.screen is below)


@pytest.mark.slow
async def test_the_rows_as_shown_are_exported(run: StoredRun, tmp_path: Path) -> None:
    file = tmp_path / "rows.parquet"
    async with open_analyser(runs=(run.id,), size=(80, 24)) as (pilot, _, model):
        await typed(pilot, "F", "=value<60", "enter", "h", "e", f"={file}", "enter")
        await until(pilot, file.exists)
        frame = read_log(file)
        assert len(frame) == len(model.rows) < model.log.rows
        assert list(frame.columns) == model.rows.columns
        assert frame["value"].max() < 60


def test_no_key_of_the_analyser_has_two_actions() -> None:
    keys = [key for action in ACTIONS.values() for key in action.key.split(",")]
    assert len(keys) == len(set(keys))
