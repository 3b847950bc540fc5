"""A remote control and a game controller, by which a hand drives the robot."""

from __future__ import annotations

from typing import Any

import pytest

from tests.engine.shim.pybricks.lab import Lab
from tuisim.engine.core.hub_spec import CONTROLLERS
from tuisim.engine.core.profile import MotorLaw
from tuisim.engine.shim.pybricks import robotics
from tuisim.engine.shim.pybricks.hsv_color import Color
from tuisim.engine.shim.pybricks.hub.controllers import Remote, XboxController
from tuisim.engine.shim.pybricks.hub.parameters import Button
from tuisim.engine.shim.pybricks.hub.parameters import Port as HubPort
from tuisim.engine.shim.pybricks.parameters import Direction
from tuisim.engine.shim.pybricks.version_4 import DriveBase, Motor, run_task

Port: Any = HubPort


@pytest.fixture
def lab() -> Lab:
    robotics.DriveBase.current = None
    kinds = dict.fromkeys("AB", "medium-angular")
    return Lab(MotorLaw.PYBRICKS_4, kinds, hub="PrimeHub")


def press(lab: Lab, presses: dict[int, str]) -> None:
    """Press keys from some times in ms on, and no others."""

    def look(now_ms: int) -> None:
        if now_ms in presses:
            lab.pressed = frozenset(presses[now_ms].split())

    lab.looks.append(look)


def build_base() -> DriveBase:
    left, right = Motor(Port.A, Direction.COUNTERCLOCKWISE), Motor(Port.B)
    return DriveBase(left, right, 56, 112)


def test_a_program_drives_the_robot_by_buttons_of_a_remote_control(lab: Lab) -> None:
    press(lab, {500: "remote.left_plus", 1500: "remote.right_minus", 2000: "remote.center"})
    remote = Remote()
    base = build_base()
    while Button.CENTER not in (pressed := remote.buttons.pressed()):
        base.drive(100 * (Button.LEFT_PLUS in pressed), -90 * (Button.RIGHT_MINUS in pressed))
        lab.spend(10_000_000)
    assert lab.now == 2_000_000_000
    assert base.distance() == pytest.approx(100, abs=5) and base.angle() < -20


def test_a_program_drives_the_robot_by_sticks_of_a_game_controller(lab: Lab) -> None:
    press(
        lab, {500: "xbox.joystick_left_up xbox.lt", 1500: "xbox.joystick_left_left", 2000: "xbox.b"}
    )
    controller = XboxController()
    base = build_base()
    while Button.B not in controller.buttons.pressed():
        right, up = controller.joystick_left()
        base.drive(up - controller.triggers()[0] // 2, right)
        lab.spend(10_000_000)
    controller.rumble(50, duration=100)
    assert base.distance() == pytest.approx(50, abs=5) and base.angle() < -20
    assert controller.profile() == 0


@pytest.mark.parametrize(
    ("pressed", "told"),
    [("", 0), ("up", 1), ("up right", 2), ("down", 5), ("up left", 8), ("up down", 0)],
)
def test_a_game_controllers_pad_tells_its_direction_as_a_number(
    lab: Lab, pressed: str, told: int
) -> None:
    lab.pressed = frozenset(f"xbox.dpad_{way}" for way in pressed.split())
    assert XboxController().dpad() == told


@pytest.mark.parametrize(("make", "port"), [(Remote, "remote"), (XboxController, "xbox")])
def test_each_key_of_a_controller_is_read_as_its_pybricks_button(
    lab: Lab, make: Any, port: str
) -> None:
    controller = make()
    lab.pressed = frozenset(CONTROLLERS[port]) | {"enter", "left"}
    names = {f"{port}.{button.name.lower()}" for button in controller.buttons.pressed()}
    ways = {key for key in CONTROLLERS[port] if key.startswith(("xbox.joystick", "xbox.dpad"))}
    assert names == {*CONTROLLERS[port]} - ways - {"xbox.lt", "xbox.rt"}


def test_the_light_of_a_remote_control_is_not_that_of_the_hub(lab: Lab) -> None:
    remote = Remote()
    remote.light.on(Color.RED)
    levels = lab.brick.led_levels
    assert levels["remote red"] == 255 and levels["red"] == levels["remote blue"] == 0


def test_a_remote_controls_buttons_work_again_only_after_reconnecting(lab: Lab) -> None:
    remote = Remote("mine")
    assert remote.name() == "mine"
    remote.disconnect()
    with pytest.raises(OSError, match="disconnected"):
        remote.buttons.pressed()
    remote.connect()
    assert remote.buttons.pressed() == set()


def test_creating_a_remote_control_inside_a_task_is_refused(lab: Lab) -> None:
    async def main() -> None:
        Remote()

    with pytest.raises(RuntimeError, match="before multitasking"):
        run_task(main())
