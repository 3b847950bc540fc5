"""What was built for a program: in one line, and as a robot file that says which line of the program asks for what."""

from __future__ import annotations

import ast
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from tuisim.base.data_class import dataclass
from tuisim.base.errors import RobotError
from tuisim.engine.core.hub_spec import HUBS
from tuisim.engine.core.spec import RobotSpec
from tuisim.engine.files import Location, save_toml, toml_key, toml_lines
from tuisim.programs.robot.assembly import BuiltRobot
from tuisim.programs.robot.library import DEVICES, PAIRS
from tuisim.programs.robot.mentions import Mentions
from tuisim.settings.robots import (
    DEFAULT_ROBOT,
    ROBOTS,
    RobotChoice,
    format_robot,
    list_table_values,
)

HUB_ROBOT = "Prime_Robot"


USUAL = ROBOTS[DEFAULT_ROBOT]
"""The robot that programs for the EV3 change."""


def find_usual(hub: str) -> RobotSpec:
    """Return the usual robot of a hub, from which the robot of a program is built.

    Args:
        hub: One of `HUBS`; empty for the EV3.
    """
    if not hub:
        return USUAL
    motor = HUBS[hub].motor
    hub_robot = ROBOTS[HUB_ROBOT]
    return replace(hub_robot, hub=hub, left_motor=motor, right_motor=motor, left_reversed=False)


def has_hidden_parts(mentions: Mentions) -> bool:
    """Return whether a program uses classes of motors or sensors, but its text shows no part that it creates."""
    if mentions.devices or mentions.pairs:
        return False
    for scope in mentions.scopes:
        for node in scope.body:
            match node:
                case ast.Name(id=name, ctx=ast.Load()) | ast.Attribute(attr=name):
                    if name in DEVICES or name in PAIRS:
                        return True
    return False


def describe_robot(built: BuiltRobot) -> str:
    """Return in words how a program's robot differs from the default one."""
    return ", ".join(part.what for part in built.parts if part.changes)


@dataclass(frozen=True, slots=True)
class ProgramRobot:
    """The robot that a program needs, which can be written as a robot file with the reason for each value."""

    program: str
    """The name of the program."""
    built: BuiltRobot | None
    """None if the program needs no other than the default one."""

    @property
    def spec(self) -> RobotSpec:
        """The specification of the robot."""
        return self.built.choice.spec if self.built else USUAL

    def list_lines(self) -> list[str]:
        """Return the lines of a robot file with the changes to the default robot, and the reason for each."""
        base = HUB_ROBOT if self.spec.hub else DEFAULT_ROBOT
        lines = [
            f"# The robot that {self.program} describes: {base} with these parts changed. "
            "-r takes this file.",
            "# Lengths in mm, angles in degrees; x to the right of the midpoint between the wheels, y forward of it.",
        ]
        top = f'base = "{base}"'
        built = self.built
        if built is None:
            return [
                *lines,
                "# It has everything on the ports that the program names.",
                "",
                top,
                f'name = "{USUAL.name}"',
            ]
        lines += [f"# Another reading is possible: {doubt}." for doubt in built.doubts]
        same = [part for part in built.parts if not part.changes and part.where]
        lines += [f"# As in {base}: {part.what} ({part.where})." for part in same]
        changed = _compare(_build_table(built.choice.spec), _build_table(ROBOTS[base]))
        comments = {
            part.path: f"{part.where}: {part.what}" if part.where else part.what
            for part in built.parts
        }
        return [*lines, "", top, *_format_lines(changed, "", comments)]

    def save(self, path: Path) -> None:
        """Write the robot atomically to a robot file; comments in an existing file are kept.

        Raises:
            RobotError: the file cannot be written, or is no robot file.
        """
        location = Location(str(path), RobotError)
        name = self.spec.name
        save_toml(
            path,
            self.list_lines(),
            location,
            lambda data: RobotChoice.parse(data, name, location).spec,
            self.spec,
        )


def _build_table(spec: RobotSpec) -> dict[str, Any]:
    """Return a robot as the parsed table of a robot file, with every value by its key."""
    return tomllib.loads("\n".join(format_robot(spec)))


def _compare(robot: Mapping[str, Any], usual: Mapping[str, Any]) -> dict[str, Any]:
    changes: dict[str, Any] = {}
    for key, value in robot.items():
        before = usual.get(key)
        if isinstance(value, dict) and isinstance(before, dict):
            if inside := _compare(value, before):
                changes[key] = inside
        elif value != before:
            changes[key] = value
    return changes


def _format_lines(table: Mapping[str, Any], place: str, notes: Mapping[str, str]) -> Iterator[str]:
    values = {key: value for key, value in table.items() if not isinstance(value, dict)}
    under = f"{place}." if place else ""
    known = list_table_values(place)
    comments = {
        key: notes.get(f"{under}{key}", known[key].help if key in known else "") for key in values
    }
    if values and place:
        yield from ("", *([f"# {notes[place]}"] if place in notes else []), f"[{place}]")
    yield from toml_lines(values, comments)
    for key, value in table.items():
        if isinstance(value, dict):
            yield from _format_lines(value, f"{under}{toml_key(key)}", notes)
