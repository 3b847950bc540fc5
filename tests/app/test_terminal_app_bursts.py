"""Keys that arrive in one burst, as over a slow line, do what the same keys do one by one."""

from __future__ import annotations

from pathlib import Path
from random import Random
from typing import Any

import pytest
from textual.app import App
from textual.pilot import Pilot
from textual.widgets import Input, OptionList, Static, TextArea

from tests.app.app_help import LOGS, open_lab, settings, until
from tuisim.analysis.source import LogRequest
from tuisim.app.analyser.app import Analyser, AnalyserApp
from tuisim.app.app import LabApp
from tuisim.app.dialogs.cells import CellsCard
from tuisim.app.terminal_app import TerminalApp
from tuisim.terminal.queries import AnswerParser

ENTER, TAB, BACK_TAB, BACKSPACE, DELETE = "\r", "\t", "\x1b[Z", "\x7f", "\x1b[3~"
UP, DOWN, RIGHT, LEFT, HOME, END = "\x1b[A", "\x1b[B", "\x1b[C", "\x1b[D", "\x1b[H", "\x1b[F"
PAGE_UP, PAGE_DOWN, F3 = "\x1b[5~", "\x1b[6~", "\x1bOR"
CTRL_A, CTRL_F, CTRL_G, CTRL_P, CTRL_S, CTRL_U, CTRL_Y, CTRL_Z = map(
    chr, (1, 6, 7, 16, 19, 21, 25, 26)
)
MOVES = [UP, DOWN, LEFT, RIGHT, HOME, END, PAGE_UP, PAGE_DOWN]
EDITS = [BACKSPACE, BACKSPACE, BACKSPACE, DELETE, TAB, ENTER]
SURFACES: dict[str, tuple[str, list[str]]] = {
    # What opens it, and what is pressed there, or in the lab once it is closed: no key that quits or runs.
    "editor": (
        "d",
        [*"abc :(#", *MOVES, *EDITS, CTRL_A, CTRL_F, CTRL_G, CTRL_U, CTRL_Y, CTRL_Z, F3, BACK_TAB],
    ),
    "dialogs": ("", [*"pvpv./", *MOVES, *EDITS, CTRL_S, "g", "T"]),
    "chooser": ("o", [*"pk./", *MOVES, *EDITS, BACK_TAB, "o"]),
    "analyser": ("", [*"bcdmnz+-", *MOVES, ENTER, TAB, BACKSPACE]),
}
BURSTS = [f"{name}-{number}" for name in SURFACES for number in range(12)]
ROWS = "".join(f"Colour: {value // 4 * 10}\n" for value in range(40))


def send(pilot: Pilot[Any], data: str) -> None:
    """Let the driver read what a terminal has sent."""
    driver, parser = pilot.app._driver, AnswerParser()
    assert driver is not None
    for message in (*parser.feed(data), *parser.feed("")):
        driver.process_message(message)


async def settle(pilot: Pilot[Any]) -> None:
    """Wait until all that was pressed has been handled, and all that it has begun."""
    app = pilot.app
    assert isinstance(app, TerminalApp)
    await pilot.pause()
    await until(
        pilot,
        lambda: app._exit or (app._input.is_idle and all(one.is_finished for one in app.workers)),
    )
    await pilot.pause()


def state(app: App[Any]) -> list[object]:
    """What a user sees of the app."""
    found: list[object] = [type(screen).__name__ for screen in app.screen_stack]
    found.append((type(app.focused).__name__, app.focused.id if app.focused else ""))
    found += [(field.value, field.selection) for field in app.screen.query(Input)]
    found += [(area.text, area.selection) for area in app.screen.query(TextArea)]
    found += [listed.highlighted for listed in app.screen.query(OptionList)]
    found += [str(message.render()) for message in app.screen.query("#message").results(Static)]
    if isinstance(app, LabApp):
        program = app.run_controller.program
        found += [program and program.name, app.run_controller.pose]
    for screen in app.screen_stack:
        if isinstance(screen, Analyser):
            model = screen.model
            found += [
                screen.pane.name_shown,
                screen.pane.chosen,
                model.row,
                model.selected,
                len(model.notes),
            ]
    found.append(
        sorted((path.name, path.read_text()) for path in Path.cwd().iterdir() if path.is_file())
    )
    return found


async def pressed(
    surface: str, keys: list[str], folder: Path, monkeypatch: pytest.MonkeyPatch
) -> list[object]:
    """Press keys, each of which may be several, in a new app; return its state."""
    folder.mkdir(parents=True)
    monkeypatch.chdir(folder)
    if surface == "analyser":
        Path("log.txt").write_text(ROWS)
        # As it opens: the log is read in the background.
        app: TerminalApp = AnalyserApp(LogRequest(file="log.txt"))
    else:
        Path("prog.py").write_text(LOGS)
        app = LabApp(settings(LOGS))
    async with app.run_test(size=(80, 24)) as pilot:
        if isinstance(app, LabApp):
            await until(pilot, lambda: app.run_controller.mat is not None)
        for data in keys:
            send(pilot, data)
            await settle(pilot)
        return state(app)


@pytest.mark.quick_cases("editor-0", "dialogs-0")
@pytest.mark.parametrize("burst", BURSTS)
async def test_a_burst_does_what_its_keys_do(
    burst: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    rng, surface = Random(burst), burst.partition("-")[0]
    opens, alphabet = SURFACES[surface]
    keys = [*opens, *rng.choices(alphabet, k=rng.randint(2, 30))]
    # What stands beside the folder is the same for both: a path that is typed may be completed there.
    one_write = await pressed(surface, ["".join(keys)], tmp_path / "at_once" / "home", monkeypatch)
    one_by_one = await pressed(surface, keys, tmp_path / "one_by_one" / "home", monkeypatch)
    assert one_write == one_by_one, keys


async def test_backspace_is_not_overtaken_by_what_is_typed_after_it() -> None:
    async with open_lab(LOGS, size=(80, 24)) as (pilot, _):
        send(pilot, f"onew.csv{BACKSPACE * 3}parquet")
        await settle(pilot)
        assert pilot.app.screen.query_one(Input).value == "new.parquet"


async def test_enter_waits_for_what_the_palette_finds() -> None:
    async with open_lab(LOGS, size=(80, 24)) as (pilot, app):
        send(pilot, f"{CTRL_P}Glyphs of the world{ENTER}")
        await until(pilot, lambda: isinstance(app.screen, CellsCard))
