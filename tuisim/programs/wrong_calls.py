"""Calls of moves with the wrong values, such as a steering call with two speeds, and what was probably meant."""

from __future__ import annotations

import ast
from collections.abc import Collection, Mapping
from typing import NamedTuple

from tuisim.base.data_class import dataclass
from tuisim.programs.statements import find_number

_ERRORS = ("TypeError", "AttributeError", "AssertionError", "SpeedInvalid", "DeviceNotDefined")
_PREDEFINED = {"tank_drive": "MoveTank", "tank_turn": "MoveSteering"}
_SPEEDS: Mapping[str, tuple[str, ...]] = {
    "MoveTank": ("left_speed", "right_speed"),
    "MoveDifferential": ("left_speed", "right_speed"),
    "MoveSteering": ("steering", "speed"),
    "LargeMotor": ("speed",),
    "MediumMotor": ("speed",),
    "Motor": ("speed",),
    "DriveBase": (),
}
"""What the methods of `_ENDS` take first, by class."""
_ENDS: Mapping[str, tuple[str, ...]] = {
    "on": (),
    "on_for_seconds": ("seconds",),
    "on_for_rotations": ("rotations",),
    "on_for_degrees": ("degrees",),
}
_OTHERS: Mapping[str, Mapping[str, tuple[str, ...]]] = {
    "MoveDifferential": {
        "on_for_distance": ("speed", "distance_mm"),
        "turn_left": ("speed", "degrees"),
        "turn_right": ("speed", "degrees"),
    },
    "DriveBase": {"drive": ("speed", "turn_rate"), "straight": ("distance",), "turn": ("angle",)},
    "Motor": {
        "run": ("speed",),
        "run_angle": ("speed", "rotation_angle"),
        "run_target": ("speed", "target_angle"),
        "run_time": ("speed", "time"),
    },
}
"""What further methods take, by class."""
_ENDLESS: Mapping[str, str] = {
    "drive": "drive goes on until stop(): straight drives a distance",
    "run": "run goes on until stop(): run_angle and run_time end by themselves",
    "on": "on goes on until off(): on_for_seconds and on_for_rotations end by themselves",
}
_SETTINGS: Mapping[str, str] = {"straight": "straight_speed", "turn": "turn_rate"}
"""For methods of `DriveBase`, the argument of `settings` that sets their speed."""
_SAME: Mapping[str, Mapping[str, str]] = {
    "DriveBase": {"on": "drive", "off": "stop", "on_for_distance": "straight", "run": "drive"},
    "Motor": {"on": "run", "off": "stop", "on_for_degrees": "run_angle", "on_for_seconds": "run_time"},
    "LargeMotor": {"run": "on", "run_angle": "on_for_degrees", "run_time": "on_for_seconds"},
    "MediumMotor": {"run": "on", "run_angle": "on_for_degrees", "run_time": "on_for_seconds"},
    "MoveTank": {"drive": "on", "straight": "on_for_rotations"},
    "MoveSteering": {"drive": "on", "straight": "on_for_rotations"},
}  # fmt: skip
"""Methods of other classes, each with that of this class which does the same."""
_NEEDS_WHEELS = ("on_for_distance", "turn_left", "turn_right")
"""Methods that only `MoveDifferential` has, or that other classes have only with a gyro."""
_MAX_SPEED = 100


@dataclass(frozen=True, slots=True)
class _Move:
    """A call of a method of a motor, or of a pair of motors."""

    owner: str
    class_name: str
    method: str
    args: tuple[ast.expr, ...]
    names: tuple[str, ...]
    """The names of its further arguments."""

    def list_parameters(self) -> tuple[str, ...]:
        """Return descriptions of the arguments that the method takes; empty if they are not known."""
        others = _OTHERS.get(self.class_name, {})
        if self.method in others:
            return others[self.method]
        ends = _ENDS.get(self.method)
        return () if ends is None else _SPEEDS[self.class_name] + ends

    def format_call(self, *args: str) -> str:
        return f"{self.owner}.{self.method}({', '.join(args)})"


def explain_call(tree: ast.Module, error: str, line: int) -> str:
    """Return what is wrong with a call of a move that raised an error, and what to write; empty if that is not known.

    Args:
        tree: The program.
        error: The name and the text of the error.
        line: The line that raised it.
    """
    if error.partition(":")[0].rpartition(".")[2] not in _ERRORS:
        return ""
    classes = find_classes(tree)
    for node in ast.walk(tree):
        match node:
            case ast.Call(
                func=ast.Attribute(value=owner, attr=method), args=args, keywords=keywords
            ):
                name = ast.unparse(owner)
                if name in classes and node.lineno <= line <= (node.end_lineno or node.lineno):
                    names = tuple(each.arg or "" for each in keywords)
                    move = _Move(name, classes[name], method, tuple(args), names)
                    return _describe_move(move, error, classes)
    return ""


class Maker(NamedTuple):
    """How a program creates a motor or a pair of motors."""

    class_name: str
    arguments: str
    """As text; two pairs with the same motors have the same text."""


def find_makers(tree: ast.Module, classes: Collection[str] = _SPEEDS) -> dict[str, Maker]:
    """Return how a program creates its devices, by the name of the variable or attribute.

    Args:
        tree: The program.
        classes: The classes of the devices: by default those of motors and pairs of motors.
    """
    makers = {
        name: Maker(class_name, "OUTPUT_B, OUTPUT_C") for name, class_name in _PREDEFINED.items()
    }
    makers |= dict.fromkeys(("colorLeft", "colorRight"), Maker("ColorSensor", ""))
    own = set[str]()
    for node in ast.walk(tree):
        match node:
            case ast.Assign(targets=[target], value=ast.Call(func=func, args=args)):
                class_name = ast.unparse(func).rpartition(".")[2]
                makers[ast.unparse(target)] = Maker(class_name, ", ".join(map(ast.unparse, args)))
            case ast.Assign(targets=[target]):
                makers[ast.unparse(target)] = Maker("", "")
            case ast.ClassDef(name=name):
                own.add(name)
    return {
        name: maker
        for name, maker in makers.items()
        if maker.class_name in classes and maker.class_name not in own
    }


def find_classes(tree: ast.Module) -> dict[str, str]:
    """Return the classes of the variables and attributes for motors and pairs of motors, by name."""
    return {name: maker.class_name for name, maker in find_makers(tree).items()}


def _describe_move(move: _Move, error: str, classes: Mapping[str, str]) -> str:
    parameters = move.list_parameters()
    if move.method in _NEEDS_WHEELS and move.class_name in ("MoveTank", "MoveSteering"):
        return f"{move.method} needs the size of the wheels: a MoveDifferential knows it"
    if "AttributeError" in error:
        other = _SAME.get(move.class_name, {}).get(move.method, "")
        return f"a {move.class_name} has {other}() for this" if other else ""
    if not parameters or any(isinstance(each, ast.Starred) for each in move.args):
        return ""
    takes = f"{move.method} of a {move.class_name} takes {', '.join(parameters)}"
    words = [ast.unparse(each) for each in move.args]
    if "keyword argument" in error:
        return takes
    speeds = [word for word, each in zip(words, move.args, strict=True) if _is_speed(each)]
    if len(speeds) > 1 and "left_speed" not in parameters:
        return _describe_speeds(move, words, speeds, classes)
    missing = len(parameters) - len(words) - len(move.names)
    if missing < 0 or move.method == "drive":
        return _describe_surplus(move, takes) if missing else ""
    is_pair = parameters[0] in ("left_speed", "steering")
    if missing == 1 and words and is_pair and len(speeds) < len(parameters) - 1:
        first = "0" if parameters[0] == "steering" else words[0]
        what = "a steering, 0 for straight on" if first == "0" else "a speed for each wheel"
        return f"a {move.class_name} takes {what}: {move.format_call(first, *words)}"
    if missing > 0:
        return takes
    if "SpeedInvalid" in error and _is_reversed(move):
        return f"{takes}, in this order: {move.format_call(*words[1:], words[0])}"
    return ""


def _is_speed(node: ast.expr) -> bool:
    """Return whether an expression is a speed with a unit, such as `SpeedPercent(30)`."""
    match node:
        case ast.Call(func=ast.Name(id=name) | ast.Attribute(attr=name)):
            return name.startswith("Speed")
        case ast.UnaryOp(operand=operand):
            return _is_speed(operand)
    return False


def _describe_speeds(
    move: _Move, words: list[str], speeds: list[str], classes: Mapping[str, str]
) -> str:
    """Return what to write instead of a call with two speeds where the method takes one.

    Args:
        move: The call.
        words: Its arguments.
        speeds: Those that are speeds.
        classes: The classes of the program's variables.
    """
    ends = words[2:]
    if "steering" not in move.list_parameters():
        return f"a {move.class_name} takes one speed here: {move.format_call(speeds[0], *ends)}"
    text = "a MoveSteering takes a steering from -100 to 100 and one speed, not two speeds"
    if speeds[0] == speeds[1]:
        return f"{text}: {move.format_call('0', speeds[0], *ends)} drives straight on"
    tanks = [name for name, class_name in classes.items() if class_name == "MoveTank"]
    if move.owner not in _PREDEFINED:
        tanks = [name for name in tanks if name not in _PREDEFINED]
    call = f"{tanks[0]}.{move.method}({', '.join(words)})" if tanks else "a MoveTank"
    return f"{text}: {call} takes two"


def _describe_surplus(move: _Move, takes: str) -> str:
    """Return what to write instead of a call with too many values, or of `drive` with only one; empty if not known."""
    last = move.args[-1] if move.args else None
    if move.method in _ENDLESS:
        return _ENDLESS[move.method]
    if move.method in _SETTINGS and last is not None and find_number(last) is not None:
        option = f"settings({_SETTINGS[move.method]}=...)"
        return f"{takes}: {move.owner}.{option} sets the speed"
    return ""


def _is_reversed(move: _Move) -> bool:
    """Return whether the numbers of a call are probably in the wrong order.

    This is so if the first number is too high for a speed, and all others may be speeds.
    """
    numbers = [find_number(each) for each in move.args]
    first, *others = [number for number in numbers if number is not None] or [0.0]
    is_known = len(others) == len(numbers) - 1 > 0 and "steering" not in move.list_parameters()
    return is_known and abs(first) > _MAX_SPEED >= max(map(abs, others))
