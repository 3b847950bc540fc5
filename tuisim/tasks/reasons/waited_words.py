"""What a run waited for, in words: what it was, and the option, key or file that gives it."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import assert_never

from tuisim.base.data_class import dataclass
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.hub_spec import CONTROLLERS, HUB_PORTS, find_touch_keys
from tuisim.engine.core.outline import build_outline
from tuisim.engine.core.sensors import measure_obstacle
from tuisim.engine.core.sensors.infrared import PROXIMITY_RANGE_MM
from tuisim.engine.core.spec import EMPTY_MAT, InfraredSpec, RunSpec, UltrasonicSpec
from tuisim.engine.obstacles import OBSTACLES
from tuisim.engine.runs.readings import BUTTONS_PORT, HUB_BUTTONS_PORT, KEYS_BY_PORT
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.tasks.reasons.blank_mat import GIVES_LINE
from tuisim.tasks.reasons.hand_presses import find_hits
from tuisim.tasks.reasons.run_data import RunData, describe_place
from tuisim.tasks.reasons.subjects import SEEN, Subject
from tuisim.tasks.reasons.unmet import AWAY, Unmet, find_unmet
from tuisim.tasks.reasons.waited import Awaited, find_awaited, find_sensor

COLORED_MAT = "Rainbow_bands"
COLOR_PLACES_MM: Mapping[str, int] = {"red": 240, "green": 440, "blue": 740, "yellow": 1245}
"""Where on that mat, in x, a robot looks at a colour."""
_KEYS = {"up": "↑", "down": "↓", "left": "←", "right": "→"}
_OWNERS = {
    BUTTONS_PORT: "the brick's",
    HUB_BUTTONS_PORT: "the hub's",
    "remote": "the remote's",
    "xbox": "the Xbox controller's",
}
"""Whose buttons are read at each of `KEYS_BY_PORT`."""
_SHORT_PRESS_S = 0.1
_MOVED_MM = 50.0
"""A robot that got no farther between the first and the last reading looks at the same place."""
_TURNED_DEG = 45.0
"""A robot that turned farther than this between two readings is meant to move."""


@dataclass(frozen=True, slots=True)
class Wait:
    """A description of what a run waited for in vain."""

    time_s: float
    """When the waiting began."""
    line: int
    text: str
    """What it waited for and what came, or what it saw only, to follow "from here on"."""
    what: str
    """A sentence on the wait without its full stop, with the remedy."""
    subject: Subject | None = None


def find_waits(data: RunData) -> list[Wait]:
    """Return descriptions of what a run waited for at its end or, if it is still running, waits for now.

    The most important description is first.

    Args:
        data: The run.
    """
    run = data.run
    all_awaited = find_awaited(data)
    is_seen = all(awaited.subject in SEEN for awaited in all_awaited)
    unmet = find_unmet(data) if is_seen else None
    verb = "it waited" if run.end else "it waits"
    if unmet and unmet.is_endless:
        # No reading can end this loop, so what the program reads meanwhile is not mentioned.
        return [_describe_unmet(verb, unmet)]
    waits = []
    for awaited in all_awaited:
        remedy = name_remedy(awaited, run.spec, run.live)
        if unmet and unmet.line == awaited.line:
            if unmet.text.endswith(AWAY) and awaited.subject in (
                Subject.DISTANCE,
                Subject.PROXIMITY,
            ):
                remedy = "turn the signs of the speeds round"
            waits.append(_describe_unmet(verb, unmet, f"; {remedy}", awaited.subject))
            continue
        name = data.sensor_names.get(awaited.port, "")
        text = describe_awaited(awaited, name)
        what = f"{text}: {remedy}"
        # A program that steers by what it sees may not wait, so the text says only what it saw.
        text = f"{'' if name else 'the '}{text}" if awaited.subject in SEEN else f"{verb}: {text}"
        waits.append(Wait(awaited.since_s, awaited.line, text, what, awaited.subject))
    return waits or ([_describe_unmet(verb, unmet)] if unmet else [])


def _describe_unmet(
    verb: str, unmet: Unmet, remedy: str = "", subject: Subject | None = None
) -> Wait:
    what = f"from {unmet.time_s:.2f} s on, line {unmet.line} waited for {unmet.text}{remedy}"
    return Wait(unmet.time_s, unmet.line, f"{verb} for {unmet.text}", what, subject)


def describe_wait(run: StoredRun) -> str:
    """Return what a run waited for in one sentence without its full stop; empty if it waited for nothing."""
    return "; ".join(wait.what for wait in find_waits(RunData(run)))


def describe_wait_with_keys(awaited: Iterable[Awaited], spec: RunSpec) -> str:
    """Return in words for the app what a run waited for, with action ids in braces; empty if it waited for nothing."""
    return "; ".join(
        f"{describe_awaited(wait)}: {name_remedy_with_keys(wait, spec)}" for wait in awaited
    )


def describe_awaited(awaited: Awaited, name: str = "") -> str:
    """Return as text what a program read without seeing what it waited for, such as `gyro on in4 was never turned`.

    Args:
        awaited: What the program waited for.
        name: The program's name for a sensor that measures; empty for none.
    """
    port = awaited.port
    value = awaited.value
    match awaited.subject:
        case Subject.BUTTONS:
            return _describe_presses(awaited) or (
                f"read {_OWNERS[port]} buttons{_name_choice(awaited)} {awaited.times:,} times, none was pressed"
            )
        case Subject.TOUCH:
            presses = _describe_presses(awaited)
            kind = "force" if port in HUB_PORTS else "touch"
            return f"{kind} sensor on {port}" + (
                f": {presses}" if presses else " was never pressed"
            )
        case Subject.REMOTE:
            presses = _describe_presses(awaited) or "no button of the remote was pressed"
            return f"infrared sensor on {port}: {presses}"
        case Subject.BEACON:
            return f"infrared sensor on {port} found no beacon"
        case Subject.COLOR:
            color = _find_color(awaited)
            return f"{name or 'colour sensor'} on {port} saw only {value}" + (
                f", not {color}" if color else ""
            )
        case Subject.DISTANCE:
            return f"{name or 'ultrasonic sensor'} on {port} saw nothing nearer than {value}"
        case Subject.PROXIMITY:
            return f"{name or 'infrared sensor'} on {port} saw nothing nearer than {value}"
        case Subject.GYRO:
            return f"{name or 'gyro'} {describe_place(port)} was never turned"
        case Subject.CONNECTION:
            return f"a server in line {awaited.line}: nobody connected"
        case Subject.DATA:
            return f"a socket in line {awaited.line}: nothing arrived"
        case Subject.GAMEPAD:
            return f"looked for a gamepad {awaited.times:,} times, none is simulated"
        case other:
            assert_never(other)


def _name_choice(awaited: Awaited) -> str:
    """Return the buttons as text, with a blank in front, if any one of several would do; else an empty text."""
    has_choice = len(awaited.sought) > 1 and not awaited.needs_all
    return f" {', '.join(awaited.sought[:-1])} and {awaited.sought[-1]}" if has_choice else ""


def _describe_presses(awaited: Awaited) -> str:
    """Return why the presses by hand did not give the program what it waited for; empty if nothing was pressed."""
    names = list(dict.fromkeys(press.name for press in awaited.pressed))
    wants = awaited.sought
    hits = find_hits(awaited.pressed, wants)
    missing = [name for name in wants if name not in names]
    if not names:
        return ""
    if not hits or (awaited.needs_all and missing):
        others = "" if awaited.subject is Subject.TOUCH else f", not {' or '.join(missing)}"
        return f"only {' and '.join(names)} {'was' if len(names) == 1 else 'were'} pressed{others}"
    if awaited.needs_all:
        return f"{' and '.join(wants)} were not pressed at the same time"
    if awaited.waits_again:
        return f"{hits[-1].name} was pressed at {hits[-1].from_s:.3g} s, and the program waits for more"
    words = f"{hits[0].name} was pressed at {hits[0].from_s:.3g} s"
    if all(press.until_s <= awaited.since_s for press in hits):
        return f"{words}, before the program first checked (at {awaited.since_s:.3g} s)"
    return f"{words}, between two checks ({awaited.pace_s:.2g} s apart)"


def _find_color(awaited: Awaited) -> str:
    """Return the first colour that the program waits for and did not see; empty if that is not known."""
    return next((name for name in awaited.sought if name != awaited.value), "")


def name_remedy(awaited: Awaited, spec: RunSpec, is_live: bool = False) -> str:
    """Return the option or file with which a run gets what its program waited for, for users of the command line.

    Args:
        awaited: What the program waited for.
        spec: The run.
        is_live: Whether the run took real time, as it must if another program connects to it.
    """
    match awaited.subject:
        case Subject.BUTTONS:
            default = "enter" if awaited.port == BUTTONS_PORT else KEYS_BY_PORT[awaited.port][0]
            return f"{_name_presses(awaited, default)}, or K in the app"
        case Subject.TOUCH:
            return _name_presses(awaited, awaited.port)
        case Subject.REMOTE:
            return _name_presses(awaited, "remote.left_up")
        case Subject.BEACON:
            return "[beacon] in a world file places one (tuisim guide world-files)"
        case Subject.COLOR:
            return _name_mat(awaited, spec)
        case Subject.DISTANCE | Subject.PROXIMITY:
            return _name_nearest(awaited, spec) or _name_obstacle(awaited, spec)
        case Subject.GYRO:
            return "only its motors turn this robot"
        case Subject.CONNECTION | Subject.DATA if is_live:
            return "start the other program while this one runs"
        case Subject.CONNECTION | Subject.DATA:
            return "--speed 1 gives the other program time to connect"
        case Subject.GAMEPAD:
            return "the brick's buttons drive by hand (--press enter@1, or K in the app)"
        case other:
            assert_never(other)


def _name_presses(awaited: Awaited, default: str) -> str:
    """Return the options that press the awaited buttons or sensors when the program reads them and for long enough.

    Args:
        awaited: What was waited for.
        default: What to press if the program accepts anything.
    """
    pressed = {press.name for press in awaited.pressed}
    names = tuple(sorted(awaited.sought, key=pressed.__contains__)) or (default,)
    is_touch, is_remote = awaited.subject is Subject.TOUCH, awaited.subject is Subject.REMOTE
    from_s = math.floor(awaited.since_s) + (2 if is_touch else 1)
    held_s = 2 if is_remote else int(awaited.needs_all)
    if awaited.pace_s > _SHORT_PRESS_S:
        held_s = max(held_s, math.ceil(awaited.pace_s))
    until = f"-{from_s + held_s}" if held_s else ""
    needed = names if awaited.needs_all else names[:1]
    options = " ".join(f"--press {name}@{from_s}{until}" for name in needed)
    return f"add {options}" if awaited.waits_again and not awaited.needs_all else options


def _only_turns(awaited: Awaited) -> bool:
    if not (awaited.pose and awaited.end) or _has_moved(awaited):
        return False
    return abs(awaited.end.heading_deg - awaited.pose.heading_deg) > _TURNED_DEG


def _has_moved(awaited: Awaited) -> bool:
    if not (awaited.pose and awaited.end):
        return False
    places = ((pose.x_mm, pose.y_mm) for pose in (awaited.pose, awaited.end))
    return math.dist(*places) > _MOVED_MM


def _name_mat(awaited: Awaited, spec: RunSpec) -> str:
    if _only_turns(awaited):
        return "the robot only turns on the spot"
    color = _find_color(awaited)
    if color in COLOR_PLACES_MM:
        if _has_moved(awaited) and spec.world.background != COLORED_MAT:
            return f"-b {COLORED_MAT} has it"
        return f"-b {COLORED_MAT} -x {COLOR_PLACES_MM[color]} has it there"
    if spec.world.background != EMPTY_MAT:
        return "-x, -y and -a place it elsewhere on the mat"
    if awaited.mode == "COL-COLOR" and color != "black":
        return f"-b {COLORED_MAT} has seven bands of colours (tuisim backgrounds)"
    return GIVES_LINE


def _name_obstacle(awaited: Awaited, spec: RunSpec) -> str:
    # A robot that has moved gets near an obstacle by itself, so the obstacle may be at any distance.
    limit = None if _has_moved(awaited) else awaited.limit
    pose = awaited.pose or spec.world.start
    sensor = find_sensor(spec, awaited.port)
    options = ""
    if isinstance(sensor, UltrasonicSpec | InfraredSpec):
        options = find_obstacle(sensor, spec, pose, limit)
    return f"{options or '-o with a file (tuisim obstacles)'} puts one in front of it"


def _name_nearest(awaited: Awaited, spec: RunSpec) -> str:
    """Return as text what an ultrasonic sensor reads with the robot at a wall, if the program waits for less.

    Otherwise, the result is empty.
    """
    sensor = find_sensor(spec, awaited.port)
    if awaited.limit is None or not isinstance(sensor, UltrasonicSpec):
        return ""
    nearest_mm = find_nearest(sensor, spec)
    is_never = awaited.limit < nearest_mm
    return f"at a wall it reads {nearest_mm / 10:.2g} cm, never less" if is_never else ""


def name_remedy_with_keys(awaited: Awaited, spec: RunSpec) -> str:
    """Return as text which key of the app gives a program what it waited for; the key's action id stands in braces.

    If no key does this, return the option of the command line that does, from `name_remedy`.
    """
    names = awaited.sought if awaited.needs_all else awaited.sought[:1]
    brick = "hub" if awaited.port in (HUB_BUTTONS_PORT, *HUB_PORTS) else "brick"
    match awaited.subject:
        case Subject.BUTTONS if awaited.port in CONTROLLERS:
            return f"{{panel-brick}} opens the hub, where the mouse presses {' and '.join(names) or 'them'}"
        case Subject.BUTTONS if names:
            keys = " and ".join(_KEYS.get(name, name.capitalize()) for name in names)
            does = f"shift with {keys} holds" if awaited.needs_all else f"{keys} presses"
            return f"{{panel-brick}} opens the {brick}, where {does} {' and '.join(names)}"
        case Subject.BUTTONS:
            return f"{{panel-brick}} opens the {brick}, whose buttons the arrows and Enter press"
        case Subject.TOUCH:
            ports = [sensor.port for sensor in spec.robot.touch_sensors]
            digits = {port: digit for digit, port in find_touch_keys(ports).items()}
            return f"{{panel-brick}} opens the {brick}, where {digits.get(awaited.port, 'the mouse')} presses it"
        case _:
            return name_remedy(awaited, spec, is_live=True)


_SHARE = 0.7
"""Distance of the proposed obstacle, as a share of the one that the program asks for."""
_NEAREST_MM = 40.0
"""Ultrasonic sensors measure nothing that is nearer than 30 mm."""


def find_nearest(sensor: UltrasonicSpec, spec: RunSpec) -> float:
    """Return the least distance in mm that an ultrasonic sensor can read: the distance with the robot at the wall."""
    front_mm = build_outline(spec.robot).front_mm if spec.profile.solid or spec.world.solid else 0.0
    return max(float(spec.profile.min_echo_mm), front_mm - sensor.y_mm)


def find_obstacle(
    sensor: UltrasonicSpec | InfraredSpec, spec: RunSpec, pose: Pose, limit: float | None
) -> str:
    """Return the options that put one of the sets in `OBSTACLES` on the mat, so that a sensor sees an obstacle.

    The result is empty if no set has such an obstacle.

    Args:
        sensor: The sensor.
        spec: The run.
        pose: The robot's pose when it looks for the obstacle.
        limit: How near the obstacle must be, in mm or, for an infrared sensor, in %; None for any distance.
    """
    sets = {name: replace(spec.world, obstacles=boxes) for name, boxes in OBSTACLES.items()}
    distances = {name: measure_obstacle(sensor, spec, world, pose) for name, world in sets.items()}
    nearest = min(distances, key=distances.__getitem__)
    if distances[nearest] < (math.inf if limit is None else limit):
        return f"-o {nearest}"
    start = spec.world.start
    if limit is None or (pose.x_mm, pose.y_mm) != (start.x_mm, start.y_mm):
        return ""
    per_unit = 1.0 if isinstance(sensor, UltrasonicSpec) else PROXIMITY_RANGE_MM / 100
    way_mm = max(_NEAREST_MM, limit * per_unit * _SHARE, build_outline(spec.robot).front_mm + 1.0)
    for name, world in sets.items():
        for box in world.obstacles:
            x_mm = math.floor(box.x_mm - sensor.y_mm - way_mm)
            if measure_obstacle(sensor, spec, world, replace(pose, x_mm=float(x_mm))) < limit:
                return f"-o {name} -x {x_mm}"
    return ""
