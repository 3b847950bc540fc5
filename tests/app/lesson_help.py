"""A lesson of three steps in the app, for tests."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

from textual.pilot import Pilot

from tests.app.app_help import settings, until
from tuisim.app.app import AppSettings, LabApp
from tuisim.app.dialogs.question import LinePrompt
from tuisim.app.snapshot import RunPhase
from tuisim.programs.program_file import read_program
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings
from tuisim.tasks.lessons.files import load_lesson
from tuisim.tasks.lessons.progress import load_progress, prepare_program

PROGRAM = (
    "x = 1\nprint('Level: 50')\ntank_drive.on_for_seconds(SpeedPercent(30), SpeedPercent(30), 2)\n"
)
LESSON = f"""\
+++
title = "Try it"
why = "It matters."
background = "Empty_Map"
start = {{ x_mm = 500, y_mm = 500, heading_deg = 0 }}

[[goal]]
name = "far"
say = "Drive."
hint = "Faster."
reach = {{ x_mm = 780, at_end = true }}

[[step]]
name = "number"
hints = ["Half of 84.", "Six times seven."]
question = {{ ask = "What is it?", answer = 42 }}
wrong = ["41"]

[[step]]
name = "drive"
run = "far"

[[step]]
name = "do"
%s
+++
Hello

```python program
{PROGRAM}```
## Think
Read **this**.
## Drive
Go on.
```python answer
{PROGRAM}```
## Do it
Now.
"""
SMALL = (80, 24)
LARGE = (120, 40)


def opened(tmp_path: Path, check: str = "show = 'chart'", text: str = "") -> AppSettings:
    """What `tuisim learn` makes of a lesson whose last step has a check, and of the text of steps after it."""
    folder = tmp_path / "lessons"
    folder.mkdir(exist_ok=True)
    path = folder / "try.md"
    path.write_text(LESSON % check + text)
    lesson = load_lesson(path)
    made = settings(lesson=lesson, goals=lesson.task, lessons_folder=str(folder), speed=0.0)
    spec = build_run_spec(Settings.merge(lesson.settings))
    return replace(made, spec=spec, program=read_program(prepare_program(lesson)).program)


def with_lines(settings_: AppSettings, count: int) -> AppSettings:
    """The same with a lesson whose text has so many lines."""
    assert settings_.lesson is not None
    return replace(
        settings_,
        lesson=replace(settings_.lesson, intro="\n\n".join(f"Line {at}" for at in range(count))),
    )


def shown(app: LabApp) -> str:
    """The text of the panel."""
    panel = app.panel_area.lesson
    lines = [] if panel is None else panel._picture.lines
    return "\n".join("".join(text for text, _ in line).rstrip() for line in lines)


async def type_answer(pilot: Pilot[Any], app: LabApp, text: str) -> None:
    await pilot.press("Q")
    await until(pilot, lambda: isinstance(app.screen, LinePrompt) and app.screen.is_ready)
    await pilot.press(*text, "enter")


async def run_over(pilot: Pilot[Any], app: LabApp) -> None:
    """Run the program to its end."""
    await pilot.press("R")
    await until(pilot, lambda: app.run_controller.state == RunPhase.ENDED and not app._last_words)


def states(name: str = "try") -> dict[str, str]:
    """The stored progress."""
    return {step: each.state.value for step, each in load_progress()[name].steps.items()}
