"""What the tests of the app share: settings, and waiting until something is so."""

from __future__ import annotations

import time
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

from textual.app import App
from textual.pilot import Pilot
from textual.widgets import Static

from tests.running import PATIENCE_S
from tuisim.app.app import AppSettings, LabApp
from tuisim.app.snapshot import RunPhase
from tuisim.app.terminal_app import TerminalApp
from tuisim.base.source import Program
from tuisim.engine.runs.recorded_run import Recording
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings

LOGS = """\
sensor_val = colorLeft.reflected_light_intensity_pc
print('Colour: ' + str(sensor_val))
tank_drive.on(SpeedPercent(50), SpeedPercent(50))
import time
while sensor_val > 0:
    sensor_val = colorLeft.reflected_light_intensity_pc
    print('Colour: ' + str(sensor_val))
    time.sleep(0.1)
tank_drive.off()
"""
ENDLESS = "tank_drive.on(SpeedPercent(10), SpeedPercent(10))\nwhile True:\n    pass\n"


def program(text: str) -> Program:
    return Program(
        name="prog.py", text=text, prelude="preloaded", path=str(Path("prog.py").absolute())
    )


def settings(text: str | None = None, background: str = "Grey_bands", **more: Any) -> AppSettings:
    spec = build_run_spec(Settings({"background": background}))
    return AppSettings(spec=spec, program=program(text) if text else None, **more)


async def until(pilot: Pilot[Any], condition: Callable[[], bool], case: str = "") -> None:
    """Let the app go on until something is so; `case` names the row of a table that a test works through."""
    give_up = time.monotonic() + PATIENCE_S
    while not condition():
        assert time.monotonic() < give_up, f"still not so: {case}"
        await pilot.pause(0.01)


def lab(pilot: Pilot[Any]) -> LabApp:
    app = pilot.app
    assert isinstance(app, LabApp)
    return app


async def ready(pilot: Pilot[Any]) -> LabApp:
    """Wait until the mat lies there."""
    app = lab(pilot)
    await until(pilot, lambda: app.run_controller.mat is not None)
    await pilot.pause()
    return app


def notices(app: App[Any]) -> list[str]:
    """What the user was told lately."""
    assert isinstance(app, TerminalApp)
    return app.notices.list_messages()


def program_of(app: LabApp) -> Program:
    """The program that is open."""
    opened = app.run_controller.program
    assert opened is not None
    return opened


def recording_of(app: LabApp) -> Recording:
    """The run in view."""
    recording = app.run_controller.timeline.recording
    assert recording is not None
    return recording


def message_of(app: LabApp) -> str:
    """What the open dialog says about what was typed."""
    return "".join(str(one.content) for one in app.screen.query("#message").results(Static))


def screen_text(app: App[Any]) -> str:
    """What is on the screen, as lines of text."""
    return "\n".join(
        "".join(s.text for s in strip) for strip in app.screen._compositor.render_strips()
    )


@asynccontextmanager
async def open_lab(
    opened: AppSettings | str | None = None,
    background: str = "Grey_bands",
    *,
    size: tuple[int, int] = (120, 40),
    **more: Any,
) -> AsyncIterator[tuple[Pilot[Any], LabApp]]:
    """Open the app as it is set, or with the text of a program and `settings`, and wait until the mat lies there."""
    if not isinstance(opened, AppSettings):
        opened = settings(opened, background, **more)
    async with LabApp(opened).run_test(size=size) as pilot:
        yield pilot, await ready(pilot)


async def until_state(pilot: Pilot[Any], state: RunPhase) -> None:
    """Wait until the run has come so far."""
    await until(pilot, lambda: lab(pilot).run_controller.state == state)


async def run_from_start(pilot: Pilot[None], app: LabApp, text: str) -> None:
    """Run a program from the start pose to its end."""
    before = app.run_controller.run_id
    app.run_controller.program = program(text)
    await pilot.press("m", "R")
    await until(
        pilot,
        lambda: app.run_controller.run_id != before and app.run_controller.state is RunPhase.ENDED,
    )


async def until_typing(pilot: Pilot[Any]) -> None:
    """Wait until the program is typed into."""

    def is_typed() -> bool:
        code = lab(pilot).panel_area.code
        return code is not None and code.typing

    await until(pilot, is_typed)


async def until_shown(pilot: Pilot[Any], text: str) -> None:
    """Wait until words stand on the screen."""
    await until(pilot, lambda: text in screen_text(lab(pilot)))


async def press_and_stand(pilot: Pilot[Any], key: str) -> None:
    """Press a key that lets the program stand anew."""
    debugger = lab(pilot).debugger
    before = debugger.view
    await pilot.press(key)
    await until(pilot, lambda: debugger.view not in (None, before))
