"""Programs on robots with every part, in real child processes."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

import pytest

from tests.profiles import EXACT
from tests.running import Done, over
from tuisim.base.source import Program
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.profile import PROFILES
from tuisim.engine.core.remote_spec import REMOTE_CHANNELS, REMOTE_CODES, BeaconSpec, RemotePress
from tuisim.engine.core.spec import (
    ColorSensorSpec,
    GyroSpec,
    InfraredSpec,
    MotorSpec,
    Obstacle,
    RobotSpec,
    RunSpec,
    TouchSpec,
    UltrasonicSpec,
    WorldSpec,
)
from tuisim.engine.runs.handle import RunHandle, RunOptions, start_run
from tuisim.settings.presses import press_actions
from tuisim.settings.robots import ROBOTS as BUILT_IN

START = Pose(500.0, 571.5, 0.0)
SQUARE = RobotSpec(wheel_spacing_mm=168.0)
"""A quarter turn on the spot is 270 whole counts, so that a move can be exact."""

PLAIN = replace(SQUARE, weight=0.0)
"""The same without inertia, so that times can be told by hand."""

EYES = RobotSpec(
    color_sensors=(),
    ultrasonic=UltrasonicSpec(),
    gyro=GyroSpec(),
    extra_motors=(MotorSpec("outA"), MotorSpec("outD", "large")),
    touch_sensors=(TouchSpec(port="in2"),),
    infrared=InfraredSpec(port="in3"),
    weight=0.0,
)
"""Everything but colour sensors, and two motors that do not drive."""

PAIRS = RobotSpec(
    color_sensors=(),
    ultrasonic=UltrasonicSpec(y_mm=60.0),
    gyro=None,
    extra_ultrasonics=(UltrasonicSpec("behind", "in2", y_mm=0.0, angle_deg=180.0),),
    touch_sensors=(
        TouchSpec("touch_left", "in3", x_mm=-40.0),
        TouchSpec("touch_right", "in4", x_mm=40.0),
    ),
)

ARM = RobotSpec(
    extra_motors=(MotorSpec("outA", low_deg=-90.0, high_deg=180.0),),
    gyro=None,
    touch_sensors=(TouchSpec("end", "in4", pressed_by="outA"),),
    left_reversed=True,
    gear_ratio=0.8,
)
"""An arm between two end stops, which presses a sensor at the lower one."""

FAR_WALL = WorldSpec(background="Empty_Map", start=START)
FURNISHED = WorldSpec(
    background="Empty_Map",
    start=START,
    solid=True,
    obstacles=(Obstacle(900.0, 400.0, 50.0, 343.0),),
    beacon=BeaconSpec(520.0, 171.5, channel=2),
    remote=(
        RemotePress(("top_left",), 0.0, 1e9, channel=4),
        RemotePress(("top_left",), 0.0, 2.0, channel=1),
        RemotePress(("bottom_right",), 2.0, 3.0, channel=1),
    ),
)
"""An obstacle 400 mm ahead, a beacon to the right, and somebody with a remote control."""

CODES = [set(buttons) for buttons, _ in sorted(REMOTE_CODES.items(), key=lambda found: found[1])]

REMOTE = WorldSpec(
    background="Empty_Map",
    start=START,
    remote=(
        *(
            RemotePress(tuple(sorted(buttons)), second, second + 1.0, channel)
            for channel in REMOTE_CHANNELS
            for second, buttons in enumerate(CODES, start=2)
        ),
        RemotePress(("bottom_left",), 20.0, 22.0),
        RemotePress(("top_left",), 20.0, 22.0, channel=2),
        RemotePress(("beacon",), 23.0, 26.0),
        RemotePress(("top_left",), 30.0, 31.0),
    ),
)
"""Somebody holds every set of buttons for a second from 2 s on, on all channels at once."""

ROBOTS = {
    "square": SQUARE,
    "plain": PLAIN,
    "eyes": EYES,
    "pairs": PAIRS,
    "default": RobotSpec(),
    "arm": ARM,
    "reversed": RobotSpec(left_reversed=True, right_reversed=True),
    "geared": RobotSpec(gear_ratio=0.5),
    "newer gyro": RobotSpec(gyro=GyroSpec(keeps_angle=True)),
    "hub": BUILT_IN["Prime_Robot"],
    "hub with an eye": replace(
        BUILT_IN["Prime_Robot"], color_sensors=(ColorSensorSpec("eye", "E", 60.0, 0.0),)
    ),
}
WORLDS = {
    "empty": FAR_WALL,
    "furnished": FURNISHED,
    "remote": REMOTE,
    "red": WorldSpec(background="Radial_red", start=Pose(900, 500, 0)),
    "lollipop": WorldSpec(background="Lollipop", start=Pose(750, 375, 180)),
}


RunOn = Callable[..., Done]


@pytest.fixture
def run_on() -> Iterator[RunOn]:
    """`run_on(text, robot="plain", world="empty", profile="exact", live=False)`: run a program to its end."""
    handles: list[RunHandle] = []

    def finish(
        text: str,
        robot: str = "plain",
        world: str = "empty",
        profile: str = "exact",
        live: bool = False,
        start: Pose | None = None,
        time_limit_s: float = 900.0,
        presses: tuple[str, ...] = (),
        speed: float = 0.0,
    ) -> Done:
        place = (
            WORLDS[world]
            if start is None
            else WorldSpec(background=WORLDS[world].background, start=start)
        )
        spec = RunSpec(ROBOTS[robot], place, {**PROFILES, EXACT.name: EXACT}[profile])
        actions = press_actions(presses, spec.profile.tick_hz)
        options = RunOptions(live=live, speed=speed, time_limit_s=time_limit_s, actions=actions)
        handles.append(start_run(Program("program.py", text, "none"), spec, options))
        return over(handles[-1])

    yield finish
    for handle in handles:
        handle.close()
