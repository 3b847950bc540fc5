"""Work on long logs, beside the screen; newer work takes the place of older."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from tests.app.analyser.test_screen import open_analyser, text_of, typed
from tests.app.app_help import notices, until
from tuisim.analysis.model import AnalysisModel
from tuisim.app.analyser import screen as screen_module
from tuisim.logs.table import TableTask

STEPS: list[tuple[list[str], Callable[[AnalysisModel], bool]]] = [
    (["F", "=value < 50 and name == a", "enter"], lambda model: len(model.rows) == 50),
    (["U", "o", "o"], lambda model: model.rows.view.descending and model.rows.row(0) == 199),
    (["U", "slash", "=77", "enter"], lambda model: model.row == 154),
    (["d", "=v = slope(a)", "enter"], lambda model: model.selected == "v"),
    (["c", "=a > 50", "enter"], lambda model: model.row == 100),
    (["b"], lambda model: model.bands() != []),
]


async def test_the_prompt_for_thresholds_has_examples_with_a_variable_of_the_log(
    tmp_path: Path,
) -> None:
    file = tmp_path / "log.csv"
    file.write_text("time,name,value\n0,Way,1\n1,Way,2\n")
    async with open_analyser(file=str(file), size=(80, 24)) as (pilot, _, _):
        await pilot.press("c")
        await until(pilot, lambda: "Way < 50, Way > 80" in text_of(pilot))
        assert "Colour" not in text_of(pilot)


@pytest.mark.slow
async def test_searching_and_sorting_a_long_log_does_not_block_the_screen(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(screen_module, "FAST_ROWS", 0)
    lines = (f"{at / 10},{'ab'[at % 2]},{at // 2}" for at in range(200))
    file = tmp_path / "log.csv"
    file.write_text("\n".join(("time,name,value", *lines)) + "\n")
    async with open_analyser(file=str(file)) as (pilot, screen, _):
        await until(pilot, lambda: screen.is_open and screen.model.opened.done)
        model = screen.model
        assert model is not None
        for keys, so in STEPS:
            await typed(pilot, *keys)
            await until(pilot, lambda: screen.job is None)
            assert so(model), keys
        await typed(pilot, "slash", "=nowhere at all", "enter")
        await until(
            pilot, lambda: any("was not found" in message for message in notices(pilot.app))
        )
        old, new = TableTask("older"), TableTask("newer")
        screen.begin(old)
        screen.begin(new)
        assert old.stopped and "newer" in text_of(pilot)
        screen.end(old, lambda: pytest.fail("the result of older work was taken"))
        screen.end(new, lambda: model.go_to_row(3))
        assert model.row == 3 and screen.job is None
        screen.begin(old)
        await pilot.press("U")
        assert screen.job is None


async def test_go_to_finds_a_threshold_also_without_spaces(tmp_path: Path) -> None:
    file = tmp_path / "log.csv"
    file.write_text("time,Way\n" + "".join(f"{at},{abs(at % 20 - 10)}\n" for at in range(60)))
    async with open_analyser(file=str(file), size=(120, 40)) as (pilot, screen, _):
        await until(pilot, lambda: screen.is_open and screen.model.opened.done)
        await pilot.press("home")
        rows: list[int] = []
        for text in ("Way<4", "Way < 4", "Way>8.5"):
            await typed(pilot, "g", f"={text}", "enter")
            await until(pilot, lambda: screen.job is None)
            rows.append(screen.model.row)
        assert rows == [7, 27, 39]
        await typed(pilot, "g", "=nonsense", "enter")
        await until(pilot, lambda: "not a row, a time or a threshold" in text_of(pilot))
