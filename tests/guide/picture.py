"""The picture of the app in README: `python -m tests.guide.picture` draws it anew."""

from __future__ import annotations

import asyncio
import os
import tempfile
from pathlib import Path

from tests.app.app_help import open_lab, until
from tests.conftest import ROOT
from tuisim.app.app import AppSettings
from tuisim.app.editor.area import CodeArea
from tuisim.app.screenshot import screen_cells
from tuisim.app.snapshot import RunPhase
from tuisim.config.build import build_run_spec
from tuisim.config.options import Settings
from tuisim.source import Program
from tuisim.terminal.cell_image import svg_of_cells

PICTURE = Path(__file__).with_name("tuisim.svg")
SIZE = (120, 40)
LOOKS = 6
"""The screen is finished when it looks the same so often: it is refined step by step."""


async def drawn() -> str:
    """Return the app as SVG: the example of the grey bands has ended, and two seconds before its end are in view."""
    text = (ROOT / "programs" / "log_greys.py").read_text(encoding="utf-8")
    program = Program(name="log_greys.py", text=text, prelude="preloaded", path="log_greys.py")
    spec = build_run_spec(Settings({"background": "Grey_bands"}))
    started = AppSettings(spec=spec, program=program, speed=0.0, panels_on=frozenset({"chart"}))
    async with open_lab(started, size=SIZE) as (pilot, app):
        await pilot.press("R")
        await until(
            pilot, lambda: app.situation().has_run and app.situation().state is RunPhase.ENDED
        )
        # During the run it has scrolled to those lines only that were drawn just then: from its top, it shows the same
        # rows each time.
        app.query_one(CodeArea).scroll_to(y=0, animate=False, force=True)
        await pilot.press("less_than_sign", "less_than_sign")
        await until(pilot, lambda: app.situation().looks_back)
        app.clear_notifications()
        seen = [""]
        while len(seen) < LOOKS or len(set(seen[-LOOKS:])) > 1:
            await pilot.pause(0.3)
            seen.append(svg_of_cells(screen_cells(app), "tuisim"))
        return seen[-1]


def main() -> None:
    """Write the picture."""
    os.environ |= {"TUISIM_HOME": tempfile.mkdtemp(), "COLORTERM": "truecolor"}
    PICTURE.write_text(asyncio.run(drawn()), encoding="utf-8")


if __name__ == "__main__":
    main()
