"""What the app sends to a terminal: each paint once, and nothing where nothing happens."""

from __future__ import annotations

from functools import partial
from itertools import count
from pathlib import Path
from typing import Any

import pytest
from textual._callback import invoke
from textual.pilot import Pilot

from tests.app.app_help import ENDLESS, LOGS, ready, settings, until
from tests.app.wires import on_wire, until_quiet, wire_of
from tests.running import PATIENCE_S
from tuisim.analysis.source import LogRequest
from tuisim.app import app as app_module
from tuisim.app.analyser.app import AnalyserApp
from tuisim.app.app import LabApp
from tuisim.app.run_update import RunUpdate
from tuisim.app.snapshot import RunPhase
from tuisim.engine.protocol import Resumed
from tuisim.terminal.pacer import Pacer

LOG = "index,variable,value,time\n0,Colour,1.0,0.1\n1,Colour,2.0,0.2\n"
BEATS = 20
ATTEMPTS = 5


@pytest.mark.slow_cases("truecolor")
@pytest.mark.parametrize("colors", ["256", "truecolor"])
async def test_the_first_paint_shows_the_panels_before_the_mat(colors: str) -> None:
    async with on_wire(LabApp(settings()), colors) as pilot:
        await ready(pilot)
        await until_quiet(pilot)

        sent = "".join(wire_of(pilot).sent)
        assert wire_of(pilot).kilobytes <= 30
        assert max(
            sent.index(title) for title in ("World", "Instrumentation", "Output")
        ) < sent.index("▀")


@pytest.mark.slow
@pytest.mark.parametrize("colors", ["256", "truecolor"])
async def test_opening_a_dialog_sends_no_more_than_one_painting(colors: str) -> None:
    async with on_wire(LabApp(settings()), colors) as pilot:
        await ready(pilot)
        await until_quiet(pilot)
        wire = wire_of(pilot)
        paints = {}
        for key in ("question_mark", "ctrl+p", "b", "o"):
            for pressed in (key, "escape"):
                wire.sent.clear()
                await pilot.press(pressed)
                await until_quiet(pilot)
                paints[key, pressed] = wire.kilobytes

    most = {pressing: 20 if pressing[1] == "escape" else 15 for pressing in paints}
    assert {pressing: kb for pressing, kb in paints.items() if not 0 < kb <= most[pressing]} == {}


def is_active(timer: Any) -> bool:
    """Whether a timer is not paused."""
    return bool(timer._active.is_set())


async def sent_at_rest(pilot: Pilot[Any]) -> str:
    """What is sent while the app looks for news many times, and finds none; empty if it comes to rest in the end."""
    for _ in range(ATTEMPTS):
        if not (sent := await sent_for_a_while(pilot)):
            break
    return sent


async def sent_for_a_while(pilot: Pilot[Any]) -> str:
    app: object = pilot.app
    await until_quiet(pilot)
    wire_of(pilot).sent.clear()
    if isinstance(app, LabApp):
        app.pacer = Pacer(app.settings.fps, clock=partial(next, count(0.0, 1.0)))
        for _ in range(BEATS):
            app._on_frame_timer()
    # Whatever has a timer of its own is due sooner or later.
    for timer in {
        timer for node in pilot.app.screen.walk_children(with_self=True) for timer in node._timers
    }:
        if timer._callback and is_active(timer) and timer._repeat != 0:
            await invoke(timer._callback)
    await until_quiet(pilot)
    return "".join(wire_of(pilot).sent)


@pytest.mark.slow
async def test_an_idle_app_sends_nothing_to_the_terminal() -> None:
    async with on_wire(LabApp(settings(LOGS))) as pilot:
        await ready(pilot)
        for keys in ([], ["question_mark"], ["escape", "ctrl+p"], ["escape", "o"], ["escape", "d"]):
            await pilot.press(*keys)

            assert await sent_at_rest(pilot) == "", keys


def has_state(app: LabApp, state: str) -> bool:
    return app.run_controller.state == state


@pytest.mark.slow
@pytest.mark.parametrize("panels", [[], ["chart"]], ids=["no chart", "chart"])
async def test_a_run_that_stands_still_or_is_over_sends_nothing(panels: list[str]) -> None:
    async with on_wire(
        LabApp(settings(ENDLESS, panels_on=frozenset(panels), autorun=True))
    ) as pilot:
        app = await ready(pilot)
        await until(pilot, lambda: app.run_controller.state == "running")
        for key, state in (("space", "paused"), ("S", "ended")):
            await pilot.press(key)
            await until(pilot, partial(has_state, app, state))
            app.clear_notifications()

            assert await sent_at_rest(pilot) == "", state


@pytest.mark.slow
async def test_the_analyser_at_rest_sends_nothing(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text(LOG, "utf-8")
    async with on_wire(AnalyserApp(LogRequest(str(path)))) as pilot:
        await until(pilot, lambda: "Colour" in "".join(wire_of(pilot).sent))

        assert await sent_at_rest(pilot) == ""


@pytest.mark.slow
async def test_the_app_rests_when_nothing_happens_and_wakes_at_a_key(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    async with on_wire(LabApp(settings())) as pilot:
        app = await ready(pilot)
        await until(pilot, lambda: not is_active(app._frame_timer))

        # However long the machine takes to look.
        monkeypatch.setattr(app_module, "_AWAKE_S", 60.0)
        await pilot.press("p")

        await until(pilot, lambda: is_active(app._frame_timer))


async def test_what_the_robot_does_is_shown_while_the_program_prints(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    async with on_wire(LabApp(settings())) as pilot:
        app = await ready(pilot)
        app.pacer = Pacer(app.settings.fps, clock=partial(next, count(0.0, 1.0)))
        monkeypatch.setattr(app.run_controller, "poll", lambda: RunUpdate([], pauses=(Resumed(),)))
        drawn: list[bool] = []
        monkeypatch.setattr(app, "draw", lambda: drawn.append(True))

        app._on_frame_timer()

        assert drawn


@pytest.mark.slow
async def test_the_first_drawn_frame_of_a_run_shows_its_first_tick(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(app_module, "_STARTING_S", 2 * PATIENCE_S)
    async with on_wire(LabApp(settings(ENDLESS))) as pilot:
        app = await ready(pilot)
        drawn: list[tuple[RunPhase, bool]] = []

        def note() -> None:
            now = app.run_controller.build_snapshot()
            drawn.append((now.state, now.instant.tick > 0))

        monkeypatch.setattr(app.pacer, "drawn", note)
        await pilot.press("R")
        await until(pilot, lambda: any(state is not RunPhase.IDLE for state, _ in drawn))

        assert next(one for one in drawn if one[0] is not RunPhase.IDLE) == (RunPhase.RUNNING, True)


@pytest.mark.slow
async def test_frames_of_a_run_that_pauses_at_its_first_line_do_not_wait_for_a_tick(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(app_module, "_STARTING_S", 2 * PATIENCE_S)
    async with on_wire(LabApp(settings(ENDLESS))) as pilot:
        app = await ready(pilot)

        await pilot.press("n")

        await until(
            pilot, lambda: app.run_controller.state is RunPhase.PAUSED and not app._starting_until_s
        )
