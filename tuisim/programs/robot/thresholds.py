"""The numbers and colours that a program compares the readings of its colour sensors with."""

from __future__ import annotations

import ast
import re
from collections import defaultdict
from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import lru_cache

from tuisim.base.data_class import dataclass
from tuisim.base.source import PRELUDE_TEXTS, Program
from tuisim.engine.core.columns import COLOR_NAMES
from tuisim.engine.core.conditions import COMPARE
from tuisim.engine.core.sensors.color import LightRead
from tuisim.engine.core.spec import RobotSpec
from tuisim.programs.robot.library import DeviceKind
from tuisim.programs.robot.mentions import Mention, Mentions, read_mentions
from tuisim.programs.robot.places import SENSOR_SPECS
from tuisim.programs.robot.scopes import Bound, Scope
from tuisim.programs.robot.source import SIGNS, TURNED, Module, parse, read_modules
from tuisim.programs.robot.values import Instance

AIM = "-"
"""The sign for a value to which the program controls the reading."""
_KEPT = {"int", "float", "round", "abs", "max", "min"}
"""Functions of a reading that is then still compared."""
_READS = {str(read): read for read in LightRead}
_MAX_STEPS = 4
"""Most variables between a reading and its comparison."""
_PRELUDE = "*prelude"


@dataclass(frozen=True, slots=True)
class ProgramThreshold:
    """A number with which a program compares a colour sensor's reading, or at which it tries to keep the reading."""

    read: LightRead
    sign: str
    """As in Python, such as `<=`, or `AIM`; the reading stands on its left."""
    value: float
    """A colour code for a colour."""
    line: int
    """Where, in the program itself."""

    def holds(self, value: float) -> bool | None:
        """Return whether the comparison is true for a reading; None if there is no comparison, see `is_aim`."""
        return None if self.is_aim else bool(COMPARE[self.sign](value, self.value))

    @property
    def is_aim(self) -> bool:
        """Whether the program tries to keep the reading at this value, as a line follower does."""
        return self.sign == AIM

    @property
    def words(self) -> str:
        """The comparison without the reading, such as `> 90` or `== Red`.

        For a target, the text is, for example, `aim 50`.
        """
        number = COLOR_NAMES[int(self.value)] if self.read.is_color else f"{self.value:g}"
        return f"{'aim' if self.is_aim else self.sign} {number}"


_READ = re.compile("|".join(rf"\.{read}\b" for read in LightRead if not read.is_color))


def find_light_read(text: str) -> LightRead:
    """Return the kind of a colour sensor's reading that comes first in the text of a program.

    The result is `LightRead.PERCENT` if the text has no such reading.
    """
    match = _READ.search(text)
    return LightRead(match[0][1:]) if match else LightRead.PERCENT


@lru_cache(maxsize=4)
def find_light_reads(program: Program, robot: RobotSpec) -> Mapping[str, LightRead]:
    """Return how a program reads each colour sensor, such as in percent, by the sensor's name.

    If it reads a sensor in several ways, the first one that it compares with a value counts, else the first of all. For
    a sensor that the text does not read, the result is that of `find_light_read`.
    """
    usual = find_light_read(program.text)
    reads: dict[str, tuple[int, LightRead]] = {}
    try:
        mentions = _read_mentions(program)
        for line, port, read in _list_reads(mentions) if mentions else ():
            reads[port] = min(reads.get(port, (line, read)), (line, read))
    except RecursionError:
        reads = {}
    light_reads = {
        sensor.name: reads.get(sensor.port, (0, usual))[1] for sensor in robot.color_sensors
    }
    for name, thresholds in find_thresholds(program, robot).items():
        compared = (limit.read for limit in thresholds if not limit.read.is_color)
        light_reads[name] = next(compared, light_reads[name])
    return light_reads


@lru_cache(maxsize=4)
def find_thresholds(
    program: Program, robot: RobotSpec
) -> Mapping[str, tuple[ProgramThreshold, ...]]:
    """Return the values with which a program compares its colour sensors, in the order of its lines, by sensor name.

    The values are read from the program's text: a value that only a run could compute is left out. The result is empty
    for a program that is not Python, or too deeply nested to be read.
    """
    try:
        return _find_thresholds(program, robot)
    except RecursionError:
        return {}


@lru_cache(maxsize=4)
def find_sensor_names(program: Program, robot: RobotSpec) -> Mapping[str, str]:
    """Return the names that a program gives the robot's sensors, such as `colorLeft`, by port.

    Sensors with two names, or without a name, are left out. The result is empty for a program that is not Python, or
    too deeply nested to be read.
    """
    try:
        mentions = _read_mentions(program)
    except RecursionError:
        return {}
    used = {*re.findall(r"\w+", program.text)}
    names: dict[str, set[str]] = defaultdict(set)
    for device in mentions.devices if mentions else ():
        kind = SENSOR_SPECS.get(device.kind)
        ports = [each.port for each in robot.sensors if kind and isinstance(each, kind)]
        port = device.port or (ports[0] if len(ports) == 1 else "")
        if port in ports and (name := next(iter(device.names), "")) in used - {port, "Port"}:
            names[port].add(name)
    return {port: name for port, (name, *others) in names.items() if not others}


def _find_thresholds(
    program: Program, robot: RobotSpec
) -> Mapping[str, tuple[ProgramThreshold, ...]]:
    mentions = _read_mentions(program)
    if mentions is None:
        return {}
    thresholds: dict[str, list[ProgramThreshold]] = {
        sensor.name: [] for sensor in robot.color_sensors
    }
    for port, threshold in _find_comparisons(mentions):
        for sensor in robot.color_sensors:
            if port in ("", sensor.port) and threshold not in thresholds[sensor.name]:
                thresholds[sensor.name].append(threshold)
    return {
        name: tuple(sorted(some, key=lambda one: one.line)) for name, some in thresholds.items()
    }


def _list_reads(mentions: Mentions) -> Iterator[tuple[int, str, LightRead]]:
    """Yield each reading of a colour sensor in the text: its line, the sensor's port, and the kind of the reading."""
    for scope in mentions.scopes:
        for node in scope.body if not scope.module.name else ():
            if isinstance(node, ast.Attribute) and node.attr in _READS:
                for port, read in _find_reads(mentions, scope, node, 0):
                    if not read.is_color:
                        yield node.lineno, port, read


@lru_cache(maxsize=1)
def _read_mentions(program: Program) -> Mentions | None:
    """Return the devices that a program and its prelude create; None if the program is not Python."""
    modules = read_modules(program)
    if not modules:
        return None
    if prelude := parse(PRELUDE_TEXTS.get(program.prelude, "")):
        modules[_PRELUDE] = Module(_PRELUDE, _PRELUDE, prelude)
        star = ast.ImportFrom(_PRELUDE, [ast.alias("*")], 0)
        tree = modules[""].tree
        modules[""] = replace(modules[""], tree=ast.Module([star, *tree.body], tree.type_ignores))
    return read_mentions(modules)


def _find_comparisons(mentions: Mentions) -> Iterator[tuple[str, ProgramThreshold]]:
    """Yield a pair for each comparison of a reading with a constant: the sensor's port, and the threshold.

    The port is empty if the program does not give it.
    """
    for scope in mentions.scopes:
        if scope.module.name:
            continue
        for node in scope.body:
            match node:
                case ast.Compare(left=left, ops=signs, comparators=others):
                    for sign, right in zip(signs, others, strict=True):
                        if word := SIGNS.get(type(sign)):
                            yield from _build_pair(mentions, scope, left, word, right)
                            yield from _build_pair(
                                mentions, scope, right, TURNED.get(word, word), left
                            )
                        left = right
                case ast.BinOp(left=left, op=ast.Sub(), right=right):
                    yield from _build_pair(mentions, scope, left, AIM, right)
                    yield from _build_pair(mentions, scope, right, AIM, left)


def _build_pair(
    mentions: Mentions, scope: Scope, reading: ast.expr, sign: str, other: ast.expr
) -> Iterator[tuple[str, ProgramThreshold]]:
    for port, read in dict.fromkeys(_find_reads(mentions, scope, reading, 0)):
        values = _find_numbers(mentions, scope, other, read)
        # A value to control the reading to must be a single number.
        if values and (sign != AIM or (len(values) == 1 and not read.is_color)):
            yield port, ProgramThreshold(read, sign, values[0], reading.lineno)


def _find_numbers(mentions: Mentions, scope: Scope, node: ast.expr, read: LightRead) -> list[float]:
    """Return the numbers that an expression can have as value, the likeliest first; for a colour, this is its code."""
    assert mentions.evaluation is not None
    values = mentions.evaluation.values(node, scope)
    if not read.is_color:
        return [value for value in values if isinstance(value, int | float)]
    names = [_parse_color(node), *(value for value in values if isinstance(value, str))]
    codes = [value for value in values if isinstance(value, int) and 0 <= value < len(COLOR_NAMES)]
    return [*(COLOR_NAMES.index(name) for name in names if name in COLOR_NAMES), *codes]


def _parse_color(node: ast.expr) -> str | None:
    """Return the name of a colour written as `Color.RED` or `ColorSensor.COLOR_RED`; None for other expressions."""
    match node:
        case ast.Attribute(attr=name) | ast.Name(id=name):
            word = name.removeprefix("COLOR_").title().replace("Nocolor", "NoColor")
            return word if word in COLOR_NAMES else None
    return None


def _find_reads(
    mentions: Mentions, scope: Scope, node: ast.expr, steps: int
) -> Iterator[tuple[str, LightRead]]:
    """Yield port and kind of each reading of a colour sensor that may be the value of an expression.

    The expression may also contain the reading through variables.

    Args:
        mentions: The devices of the program.
        scope: The scope that contains the expression.
        node: The expression.
        steps: How many variables were followed to the expression; after `_MAX_STEPS` no more are followed.
    """
    match node:
        case (
            ast.Attribute(value=base, attr=name)
            | ast.Call(func=ast.Attribute(value=base, attr=name))
        ) if name in _READS:
            if (sensor := _find_sensor(mentions, scope, base)) is not None:
                yield sensor.port, _READS[name]
        case ast.Call(func=ast.Name(id=name), args=args) if name in _KEPT:
            for part in args:
                yield from _find_reads(mentions, scope, part, steps)
        case ast.NamedExpr(value=value):
            yield from _find_reads(mentions, scope, value, steps)
        case ast.Name(id=name) if steps < _MAX_STEPS:
            for binding in scope.find_bindings(name):
                if isinstance(binding, Bound) and not binding.path and not binding.is_item:
                    yield from _find_reads(mentions, binding.scope, binding.node, steps + 1)


def _find_sensor(mentions: Mentions, scope: Scope, node: ast.expr) -> Mention | None:
    assert mentions.evaluation is not None
    for value in mentions.evaluation.values(node, scope):
        if isinstance(value, Instance):
            for device in mentions.devices:
                if device.kind is DeviceKind.COLOR and device.makes(value):
                    return device
    return None
