"""Hostile text in the app: whatever a program is called and prints, no control character is drawn."""

from __future__ import annotations

import asyncio
from dataclasses import replace
from pathlib import Path
from random import Random

from tests.app.app_help import open_lab, screen_text, settings, until
from tests.proof.kind import FaultError
from tuisim.app.app import LabApp
from tuisim.base.source import Program
from tuisim.settings.preferences import keep

KEYS = ("c", "G", "l", "escape", "f1", "o", "escape", "question_mark", "escape")
"""Panels, the analyser and dialogs that show names and texts of runs."""


def _check_screen(app: LabApp, where: str) -> None:
    text = screen_text(app)
    bad = {
        letter for letter in text if letter != "\n" and (letter < " " or "\x7f" <= letter < "\xa0")
    }
    if bad or "\u202e" in text:
        raise FaultError(f"{where}: the screen holds {bad or 'a change of direction'}")


async def _shown(name: str, text: str, random: Random) -> None:
    program = Program(name=name, text=text, prelude="preloaded", path=str(Path(name).absolute()))
    chosen = replace(settings(background="Empty_Map", speed=0.0), program=program)
    async with open_lab(chosen, size=random.choice([(80, 24), (120, 40)])) as (pilot, app):
        _check_screen(app, "at the start")
        await pilot.press("R")
        run = app.run_controller
        await until(pilot, lambda: run.run is not None and run.run.ended is not None)
        for key in random.sample(KEYS, len(KEYS)):
            await pilot.press(key)
            await pilot.pause()
            _check_screen(app, f"after {key}")


def check_shown(name: str, text: str, random: Random) -> None:
    """Run a program in the app, look at it in many ways, and check what is drawn."""
    keep("welcomed", True)
    Path(name).write_text(text, errors="replace")
    asyncio.run(_shown(name, text, random))
