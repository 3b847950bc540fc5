"""The motors of a program that has no library: it looks for ports, such as `outA`, in the files of the brick."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator
from dataclasses import replace

from tuisim.engine.core.spec import OUTPUT_PORTS
from tuisim.programs.robot.library import DeviceKind, parse_port
from tuisim.programs.robot.mentions import Mention, Mentions, Where
from tuisim.programs.robot.source import Module


def add_port_texts(mentions: Mentions, modules: Iterable[Module]) -> Mentions:
    """Return the mentions of a program, completed with motors if the program creates no device.

    There is a motor for each port that a text in the program names, such as `outA`.
    """
    if mentions.devices or mentions.pairs:
        return mentions
    motors: dict[str, Mention] = {}
    for module in modules:
        for motor in _find_motors(module):
            known = motors.setdefault(motor.port, motor)
            motors[motor.port] = known if known.names else motor
    return replace(mentions, devices=tuple(motors.values()))


def _find_motors(module: Module) -> Iterator[Mention]:
    names: dict[ast.AST, tuple[str, ...]] = {}
    for node in ast.walk(module.tree):
        match node:
            case ast.Assign(targets=[ast.Name(id=name)], value=value):
                names |= dict.fromkeys(ast.walk(value), (name,))
            case ast.Constant(value=str(text)) if (port := parse_port(text)) in OUTPUT_PORTS:
                where = Where(module.file, node.lineno)
                yield Mention(DeviceKind.MOTOR, port, where, names.get(node, ()))
