"""The brick panel: keys and mouse press its buttons, and it shows what the program lets it show."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from tests.app.app_help import notices, open_lab, program, settings, until
from tests.app.panel_help import PanelApp, moment
from tuisim.app.app import LabApp
from tuisim.app.panels.brick import Brick
from tuisim.app.snapshot import RunPhase
from tuisim.base.source import Program
from tuisim.engine.core.profile import PROFILES
from tuisim.engine.core.spec import RobotSpec, RunSpec, TouchSpec, WorldSpec
from tuisim.settings.robots import ROBOTS

FRAME_COLS = 6
"""Columns of a frame beside the words in it."""
WATCHES = """\
from ev3dev2.button import Button
from ev3dev2.led import Leds
from ev3dev2.display import Display
from ev3dev2.console import Console
from time import sleep
buttons, leds, display = Button(), Leds(), Display()
leds.set_color('LEFT', 'RED')
display.rectangle(True, 20, 20, 150, 100)
display.update()
print('ready')
while True:
    seen = buttons.buttons_pressed
    if seen:
        print('+'.join(seen))
        if 'down' in seen:
            Console().text_at('Mission 7')
        if 'backspace' in seen:
            break
    sleep(0.02)
"""


BUMPS = """\
from pybricks.hubs import PrimeHub
from pybricks.parameters import Port
from pybricks.pupdevices import ForceSensor
from pybricks.tools import wait
hub, bumper = PrimeHub(), ForceSensor(Port.E)
print('ready')
while not bumper.pressed():
    wait(10)
print('bump')
"""


def printed(app: LabApp) -> list[str]:
    assert app.run_controller.run is not None
    return [row.text for row in app.run_controller.run.output.read_all_rows() if row.stream == 1]


def drawn(app: LabApp) -> str:
    """What the panel shows, as lines of text."""
    assert app.panel_area.brick is not None
    return "\n".join(
        "".join(text for text, _ in line) for line in app.panel_area.brick._picture.lines
    )


def actions(app: LabApp) -> list[list[str]]:
    assert app.run_controller.run is not None
    path = app.run_controller.run.folder / "actions.jsonl"
    return (
        [json.loads(line)["pressed"] for line in path.read_text().splitlines()]
        if path.exists()
        else []
    )


@pytest.mark.slow
@pytest.mark.parametrize("robot", ["Default_Robot", "Prime_Robot"])
async def test_the_keys_of_the_brick_fit_in_the_frame_of_a_narrow_panel(robot: str) -> None:
    app = PanelApp(Brick())
    async with app.run_test(size=(65, 14)) as pilot:
        now = moment()
        app.panel.show(replace(now, spec=replace(now.spec, robot=ROBOTS[robot])))
        app.panel.focus()
        await pilot.pause()
        assert 0 < len(str(app.panel.border_subtitle)) <= 65 - FRAME_COLS


async def test_keys_press_the_bricks_buttons_while_its_panel_has_the_focus() -> None:
    async with open_lab(WATCHES) as (pilot, app):
        await pilot.press("K")
        await until(pilot, lambda: isinstance(app.focused, Brick))
        await pilot.press("enter")
        assert any("while a program runs" in text for text in notices(app))
        await pilot.press("R")
        await until(pilot, lambda: "ready" in printed(app))
        pose = app.run_controller.pose

        await pilot.press("left")
        await until(pilot, lambda: "left" in printed(app))
        await until(pilot, lambda: actions(app)[-1:] == [[]])
        await pilot.press("shift+up")
        await pilot.press("enter")
        await until(pilot, lambda: "up+enter" in printed(app))
        assert app.run_controller.pose == pose
        await until(pilot, lambda: "red" in drawn(app))

        await pilot.press("down")
        await until(pilot, lambda: "Mission 7" in drawn(app))
        await pilot.press("backspace")
        await until(pilot, lambda: not app.run_controller.in_run)
        assert app.panel_area.brick is not None
        assert app.panel_area.brick.held == frozenset()


@pytest.mark.slow
async def test_a_late_release_of_a_tapped_button_after_the_run_does_not_fail() -> None:
    async with open_lab(WATCHES) as (pilot, app):
        await pilot.press("K", "R")
        await until(pilot, lambda: "ready" in printed(app))
        panel = app.panel_area.brick
        assert panel is not None
        panel.action_tap("down")
        panel.release_all()
        # As the timer does that had fired already.
        panel._release_tapped("down", 0.0)
        assert panel.held == frozenset()


async def test_a_digit_presses_a_force_sensor_whose_port_is_a_letter() -> None:
    robot = replace(ROBOTS["Prime_Robot"], touch_sensors=(TouchSpec("bumper", "E"),))
    spec = RunSpec(robot, WorldSpec(), PROFILES["pybricks4"])
    program = Program("bumps.py", BUMPS, prelude="none")
    async with open_lab(replace(settings(), spec=spec, program=program)) as (pilot, app):
        await pilot.press("K", "R")
        await until(pilot, lambda: isinstance(app.focused, Brick))
        await until(pilot, lambda: app.run_controller.run is not None and "ready" in printed(app))
        assert app.panel_area.brick is not None
        assert "1…4 force" in str(app.panel_area.brick.border_subtitle)
        await pilot.press("1")
        await until(pilot, lambda: "bump" in printed(app))


@pytest.mark.slow
async def test_a_past_instant_shows_the_bricks_display_and_buttons_of_then() -> None:
    async with open_lab(WATCHES) as (pilot, app):
        await pilot.press("K", "R")
        await until(pilot, lambda: "ready" in printed(app))
        await pilot.press("down")
        await until(pilot, lambda: "Mission 7" in drawn(app))
        await pilot.press("space")
        await until(pilot, lambda: app.run_controller.state == "paused")
        app.run_controller.timeline.go(1)
        app.draw(force=True)
        await until(pilot, lambda: "Mission 7" not in drawn(app))
        assert app.run_controller.build_snapshot().pressed == frozenset()


@pytest.mark.slow
async def test_plus_makes_the_brick_panel_full_screen_and_small_again() -> None:
    async with open_lab(WATCHES) as (pilot, app):
        await pilot.press("K", "plus")
        await pilot.pause()
        assert [panel for panel in app.panel_area.panels if app.panel_area.is_shown(panel)] == [
            "brick"
        ]
        assert app.panel_area.panels["brick"].size.width > 110
        await pilot.press("plus")
        await pilot.pause()
        assert app.panel_area.is_shown("world")
        await pilot.press("plus", "W")
        await pilot.pause()
        assert app.panel_area.is_shown("world")


@pytest.mark.slow
async def test_a_branch_begins_with_no_button_held() -> None:
    async with open_lab(WATCHES, speed=4.0, panels_on=frozenset({"brick"})) as (pilot, app):
        await pilot.press("R")
        await until(pilot, lambda: "ready" in printed(app))
        assert app.panel_area.brick is not None
        app.panel_area.brick.focus()
        await pilot.press("shift+up")
        await until(pilot, lambda: "up" in printed(app))
        assert actions(app) == [["up"]]
        await pilot.press("comma")
        await until(pilot, lambda: app.run_controller.build_snapshot().past)
        await pilot.press("enter")
        await until(pilot, lambda: any("only in the present" in text for text in notices(app)))
        assert app.run_controller.pressed == {"up"}
        await pilot.press("y", "y")
        await until(
            pilot,
            lambda: (
                app.run_controller.state in (RunPhase.RUNNING, RunPhase.PAUSED)
                and actions(app) == [["up"], []]
            ),
        )
        assert (app.run_controller.pressed, app.panel_area.brick.held) == (frozenset(), frozenset())


WAITS_FOR_TOUCH = """\
from ev3dev2.sensor.lego import TouchSensor
from time import sleep
bumper = TouchSensor('in1')
bumper.wait_for_pressed()
print('pressed')
bumper.wait_for_released()
print('released')
while True:
    sleep(0.1)
"""
WITH_BUMPER = RunSpec(
    RobotSpec(ultrasonic=None, touch_sensors=(TouchSpec(port="in1"),)),
    WorldSpec(),
    PROFILES["ev3"],
)


@pytest.mark.slow
@pytest.mark.parametrize("by_mouse", [False, True])
async def test_a_bumper_is_pressed_by_key_and_by_mouse(by_mouse: bool) -> None:
    async with open_lab(replace(settings(WAITS_FOR_TOUCH), spec=WITH_BUMPER)) as (pilot, app):
        await pilot.press("K", "R")
        await until(pilot, lambda: app.run_controller.state is RunPhase.RUNNING)
        await until(pilot, lambda: "in1" in drawn(app))
        brick = app.panel_area.brick
        assert brick is not None
        if by_mouse:
            box = next(box for box in brick._picture.buttons if box.name == "in1")
            await pilot.mouse_down(brick, offset=(box.first + 2, box.row + 1))
            await until(pilot, lambda: "pressed" in printed(app))
            await pilot.mouse_up(brick, offset=(box.first + 2, box.row + 1))
        else:
            await until(pilot, lambda: isinstance(app.focused, Brick))
            await pilot.press("1")
        await until(pilot, lambda: printed(app) == ["pressed", "released"])
        assert actions(app) == [["in1"], []]


WAITS_FOR_REMOTE = """\
from pybricks.parameters import Button
from pybricks.pupdevices import Remote
from pybricks.tools import wait
remote = Remote()
while Button.RIGHT_PLUS not in remote.buttons.pressed():
    wait(20)
print('pressed')
while True:
    wait(100)
"""
WITH_HUB = RunSpec(ROBOTS["Prime_Robot"], WorldSpec(), PROFILES["pybricks4"])


@pytest.mark.slow
async def test_the_mouse_does_not_press_the_keys_of_a_remote_control() -> None:
    remote = replace(program(WAITS_FOR_REMOTE), prelude="none")
    setup = replace(settings(), spec=WITH_HUB, program=remote)
    async with open_lab(setup) as (pilot, app):
        await pilot.press("K", "R")
        await until(pilot, lambda: "R+" in drawn(app))
        brick = app.panel_area.brick
        assert brick is not None and "Brick: PrimeHub" in str(brick.border_title)
        box = next(box for box in brick._picture.buttons if box.name == "remote.right_plus")
        await pilot.mouse_down(brick, offset=(box.first + 2, box.row + 1))
        await until(pilot, lambda: printed(app) == ["pressed"])
        await pilot.mouse_up(brick, offset=(box.first + 2, box.row + 1))
        await until(pilot, lambda: actions(app) == [["remote.right_plus"], []])


PRESSED = """\
# %%sim_magic_preloaded --press enter@0.3-600
from ev3dev2.button import Button
Button().wait_for_pressed('enter')
print('went on')
while True:
    pass
"""


@pytest.mark.slow
async def test_presses_planned_in_the_first_line_happen_in_the_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "waits.py").write_text(PRESSED)
    async with open_lab() as (pilot, app):
        app.loader.open_file("waits.py")
        await pilot.press("K", "R")
        await until(pilot, lambda: "went on" in printed(app))
        assert app.run_controller.build_snapshot().pressed == {"enter"}
        assert actions(app) == [["enter"]]
        await pilot.press("S")
        await until(pilot, lambda: not app.run_controller.in_run)
        app.loader.apply_text("print('other')", str(tmp_path / "waits.py"), "waits.py")
        assert app.run_controller.next_run.actions == ()
