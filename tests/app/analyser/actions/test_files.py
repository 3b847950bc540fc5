"""What leaves the analyser: rows, chart and report, on a real run."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pandas as pd
import pytest
from textual.pilot import Pilot
from textual.widgets import Input, Static

from tests.app.app_help import notices, until
from tuisim.analysis.source import LogRequest
from tuisim.app.analyser.app import Analyser, AnalyserApp
from tuisim.app.dialogs.save import FileDialog
from tuisim.engine.runs.frames import build_samples_frame
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.logs.export import log_metadata
from tuisim.logs.frames import read_log
from tuisim.logs.reader import open_log


async def answered(pilot: Pilot[Any], key: str, text: object) -> str:
    """Press a key and answer what it asks; return what is wrong with the answer, empty if it was taken."""
    await pilot.press(key)
    await until(pilot, lambda: isinstance(pilot.app.screen, FileDialog))
    asking = pilot.app.screen
    asking.query_one(Input).value = str(text)
    message = asking.query_one("#message", Static)
    await pilot.press("enter")
    await until(pilot, lambda: isinstance(pilot.app.screen, Analyser) or str(message.content) != "")
    return str(message.content) if pilot.app.screen is asking else ""


async def ready(pilot: Pilot[Any]) -> Analyser:
    """Wait until the log is there."""
    await until(pilot, lambda: isinstance(pilot.app.screen, Analyser) and pilot.app.screen.is_open)
    assert isinstance(pilot.app.screen, Analyser)
    return pilot.app.screen


BAD = (
    ("S", "c.gif", "a chart ends in .svg, .png, .txt"),
    ("E", "gone/r.html", "there is no folder"),
)


@pytest.mark.slow
async def test_exports_of_the_analyser_hold_the_view_as_it_is_shown(
    run: StoredRun, tmp_path: Path
) -> None:
    svg, text, page, rows = (tmp_path / name for name in ("c.svg", "c.txt", "r.html", "rows.jsonl"))
    async with AnalyserApp(LogRequest(runs=(run.id,))).run_test(size=(80, 24)) as pilot:
        screen = await ready(pilot)
        for key, name, wrong in BAD:
            assert wrong in await answered(pilot, key, tmp_path / name)
            await pilot.press("escape")
            await ready(pilot)
        assert list(tmp_path.iterdir()) == []
        await answered(pilot, "E", page)
        await answered(pilot, "e", rows)
        # Earlier halves of the time are zoomed away: the chart as shown begins later.
        await pilot.press("end", "z", "z")
        for target in (svg, text):
            await answered(pilot, "S", target)
        assert screen.is_open and screen.model.limits is not None
        first_s = screen.model.limits[0]
        await until(pilot, lambda: page.exists() and rows.exists())
        await until(
            pilot,
            lambda: "Report saved to" in "".join(notices(pilot.app)),
        )
    frame = build_samples_frame([run])
    pd.testing.assert_frame_equal(read_log(rows), frame, check_exact=True)
    assert open_log(rows).metadata == json.loads(json.dumps(log_metadata("samples", frame, [run])))
    ticks = [
        float(node.text or "nan")
        for node in ElementTree.parse(svg).iter("{http://www.w3.org/2000/svg}text")
        if (node.text or "").replace(".", "").isdigit() and float(node.attrib["y"]) > 370
    ]
    assert ticks and min(ticks) >= first_s > 1.0
    lines = text.read_text().splitlines()
    assert max(map(len, lines)) <= 80 and any("Colour" in line for line in lines)
    assert "100.00 white" in page.read_text() and "<h2>Program prog.py</h2>" in page.read_text()


@pytest.mark.quick_cases("e")
@pytest.mark.parametrize("key", ["e", "S"])
async def test_an_export_replaces_an_existing_file_only_on_a_second_enter(
    run: StoredRun, tmp_path: Path, key: str
) -> None:
    target = tmp_path / {"e": "rows.csv", "S": "chart.svg"}[key]
    target.write_text("mine")
    async with AnalyserApp(LogRequest(runs=(run.id,))).run_test(size=(80, 24)) as pilot:
        await ready(pilot)
        assert f"{target.name} already exists" in await answered(pilot, key, target)
        assert target.read_text() == "mine"
        await pilot.press("enter")
        await until(pilot, lambda: target.read_text() not in ("mine", ""))
