"""What a program says about how its motors are mounted: reversed, with end stops, pressing a touch sensor."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from tuisim.config.program_robot import library
from tuisim.config.program_robot.evaluation import Evaluation
from tuisim.config.program_robot.library import Kind
from tuisim.config.program_robot.mentions import Mentions, Pair, Where
from tuisim.config.program_robot.scopes import Scope
from tuisim.config.program_robot.values import Instance, OwnClass

_INVERSED, _NORMAL = "inversed", "normal"
_ENDLESS = frozenset({"on", "run_forever", "run_direct"})
_ENDING = frozenset(
    {"on_for_degrees", "on_for_rotations", "on_for_seconds", "on_to_position", "run_to_rel_pos", "run_to_abs_pos",
     "run_timed"}
)  # fmt: skip
_SPEEDS = ("speed", "speed_sp", "duty_cycle_sp")
_LENGTHS = ("degrees", "position", "position_sp")
_USUAL_REACH_DEG = 180.0
_MARGIN_DEG = 45.0
"""How far the end stop, at which a motor finds its place, is from where it is at the start."""
_MOST_REACH_DEG = 20_000.0


@dataclass(frozen=True, slots=True)
class Stop:
    """A motor that drives against an end stop."""

    where: Where
    forwards: bool | None
    """Its direction; None if the program does not say it."""


@dataclass(frozen=True, slots=True)
class Press:
    """A motor that presses a touch sensor at its end."""

    touch: str
    """The port of the sensor; empty if the program does not say it."""
    motor: str
    stop: Stop


@dataclass(slots=True)
class Mechanics:
    """What a program says about its motors, by port; the port is empty if the program does not say it."""

    reversed: dict[str, Where] = field(default_factory=dict)
    stops: dict[str, Stop] = field(default_factory=dict)
    presses: list[Press] = field(default_factory=list)
    reach_deg: dict[str, float] = field(default_factory=dict)
    """The farthest that the program turns a motor in one move."""

    def range_of(self, port: str) -> tuple[float, float] | None:
        """Return the end stops of a motor, from its position at the start; None if it has none."""
        stop = self.stops.get(port) or next((press.stop for press in self.presses if press.motor == port), None)
        if stop is None:
            return None
        reach = max(_USUAL_REACH_DEG, min(self.reach_deg.get(port, 0.0), _MOST_REACH_DEG)) + _MARGIN_DEG
        if stop.forwards is None:
            return -reach, reach
        return (-reach, _MARGIN_DEG) if stop.forwards else (-_MARGIN_DEG, reach)


def mechanics_in(mentions: Mentions) -> Mechanics:
    """Return what a program says about how its motors are mounted."""
    if mentions.evaluation is None:
        return Mechanics()
    return _Reader(mentions, mentions.evaluation).read()


@dataclass(slots=True)
class _Reader:
    mentions: Mentions
    evaluation: Evaluation
    found: Mechanics = field(default_factory=Mechanics)
    normal: set[str] = field(default_factory=set)

    def read(self) -> Mechanics:
        for pair in self.mentions.pairs:
            if library.PAIRS[pair.class_name].reverses and pair.polarity != _NORMAL:
                self._turn((pair.left, pair.right), _INVERSED, pair.where)
        for scope in self.mentions.scopes:
            for node in scope.body:
                self._read(node, scope)
            for block in _blocks(scope):
                for before, statement in zip([None, *block], block, strict=False):
                    self._read_press([*([before] if before else []), statement], scope)
        for port in self.normal:
            # A program that turns the polarity to and fro tries it out.
            self.found.reversed.pop(port, None)
        return self.found

    def _read(self, node: ast.AST, scope: Scope) -> None:
        match node:
            case ast.Assign(targets=targets, value=value):
                for target in targets:
                    if isinstance(target, ast.Attribute) and target.attr == "polarity":
                        for text in self.evaluation.values(value, scope):
                            self._turn(self._known_motors(target.value, scope), text, _where(node, scope))
            case ast.Call(func=ast.Attribute(value=base, attr="set_polarity"), args=[value, *_]):
                for text in self.evaluation.values(value, scope):
                    self._turn(self._known_motors(base, scope), text, _where(node, scope))
            case ast.Attribute(value=base, attr="is_stalled"):
                self._stall(base, scope, node)
            case ast.Compare(left=left, comparators=[ast.Attribute(value=base, attr="state")]):
                if "stalled" in self.evaluation.values(left, scope):
                    self._stall(base, scope, node)
            case ast.Call(func=ast.Attribute(value=base, attr="wait_until"), args=[state, *_]):
                if "stalled" in self.evaluation.values(state, scope):
                    self._stall(base, scope, node)
            case ast.Call(func=ast.Attribute(value=base, attr="wait_until_not_moving")):
                ports = self._motors(base, scope)
                if self._moves(scope, ports, _ENDLESS) and not self._moves(scope, ports, _ENDING):
                    self._stall(base, scope, node)
            case ast.Call(func=ast.Attribute(value=base, attr=name)) if name in _ENDING:
                self._note_reach(node, name, self._motors(base, scope), scope)

    def _turn(self, ports: Iterable[str], text: object, where: Where) -> None:
        for port in ports:
            if text == _INVERSED:
                self.found.reversed.setdefault(port, where)
            elif text == _NORMAL:
                self.normal.add(port)

    def _stall(self, base: ast.expr, scope: Scope, node: ast.AST) -> None:
        for port in self._motors(base, scope):
            forwards = next(self._directions(scope.body, [port], scope), None)
            self.found.stops.setdefault(port, Stop(_where(node, scope), forwards))

    # Movements

    def _calls(
        self, nodes: Iterable[ast.AST], ports: Iterable[str], names: Iterable[str], scope: Scope
    ) -> list[ast.Call]:
        wanted, known = {*ports}, {*names}
        return [
            node
            for node in nodes
            if isinstance(node, ast.Call)
            and isinstance(node.func, ast.Attribute)
            and node.func.attr in known
            and wanted & {*self._motors(node.func.value, scope)}
        ]

    def _moves(self, scope: Scope, ports: Iterable[str], names: Iterable[str]) -> bool:
        return bool(self._calls(scope.body, ports, names, scope))

    def _directions(self, nodes: Iterable[ast.AST], ports: Iterable[str], scope: Scope) -> Iterator[bool]:
        """Yield whether the movements without an end among some nodes are forwards."""
        for call in self._calls(nodes, ports, _ENDLESS, scope):
            given = [keyword.value for keyword in call.keywords if keyword.arg in _SPEEDS]
            for node in (*given, *call.args[:1]):
                inside = node.args[0] if isinstance(node, ast.Call) and node.args else node
                for value in self.evaluation.values(inside, scope):
                    if isinstance(value, int | float) and value:
                        yield value > 0

    def _note_reach(self, call: ast.Call, name: str, ports: Iterable[str], scope: Scope) -> None:
        turns = 360.0 if name == "on_for_rotations" else 1.0
        given = [keyword.value for keyword in call.keywords if keyword.arg in (*_LENGTHS, "rotations")]
        if name.startswith("on_") and name != "on_for_seconds":
            given += call.args[1:2]
        for node in given:
            for value in self.evaluation.values(node, scope):
                if isinstance(value, int | float):
                    for port in ports:
                        self.found.reach_deg[port] = max(self.found.reach_deg.get(port, 0.0), abs(value) * turns)

    # Touch sensors

    def _read_press(self, statements: list[ast.stmt], scope: Scope) -> None:
        """Note a motor that runs until a touch sensor is pressed, while nothing else moves."""
        last = statements[-1]
        match last:
            case ast.While(test=ast.UnaryOp(op=ast.Not(), operand=ast.Attribute(value=base, attr="is_pressed"))):
                pass
            case ast.While(
                test=ast.UnaryOp(op=ast.Not(), operand=ast.Call(func=ast.Attribute(value=base, attr="value")))
            ):
                pass
            case ast.Expr(value=ast.Call(func=ast.Attribute(value=base, attr="wait_for_pressed"))):
                pass
            case _:
                return
        touches = self._devices(base, scope, Kind.TOUCH)
        nodes = [inner for statement in statements for inner in ast.walk(statement)]
        moved = {
            port
            for node in nodes
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute)
            and node.func.attr in (*_ENDLESS, *_ENDING)
            for port in self._motors(node.func.value, scope)
        }  # fmt: skip
        if len(moved) == 1 and touches:
            forwards = next(self._directions(nodes, moved, scope), None)
            self.found.presses.append(Press(touches[0], moved.pop(), Stop(_where(last, scope), forwards)))

    # Devices

    def _known_motors(self, node: ast.expr, scope: Scope) -> list[str]:
        """Return the ports of the motors that an expression can be; none if it stands for one of several in turn."""
        calls = [value.call for value in self.evaluation.values(node, scope) if isinstance(value, Instance)]
        in_turn = any(sum(one.call is call for one in self.mentions.devices) > 1 for call in calls if call)
        return [] if in_turn else self._motors(node, scope)

    def _motors(self, node: ast.expr, scope: Scope) -> list[str]:
        return self._devices(node, scope, Kind.LARGE, Kind.MEDIUM, Kind.MOTOR)

    def _devices(self, node: ast.expr, scope: Scope, *kinds: Kind) -> list[str]:
        """Return the ports of the devices of some kinds that an expression can be."""
        if isinstance(node, ast.Attribute) and node.attr in ("left_motor", "right_motor"):
            pairs = self._pairs(node.value, scope)
            if pairs:
                return [pair.left if node.attr == "left_motor" else pair.right for pair in pairs]
        found = [port for pair in self._pairs(node, scope) for port in (pair.left, pair.right)]
        for value in self.evaluation.values(node, scope):
            if isinstance(value, Instance):
                found += [
                    one.port
                    for one in self.mentions.devices
                    if one.kind in kinds and self._is_of(value, one.call, one.owner)
                ]
        return list(dict.fromkeys(found))

    def _pairs(self, node: ast.expr, scope: Scope) -> list[Pair]:
        found = []
        for value in self.evaluation.values(node, scope):
            if isinstance(value, Instance):
                found += [pair for pair in self.mentions.pairs if self._is_of(value, pair.call, pair.owner)]
        return found

    @staticmethod
    def _is_of(value: Instance, call: ast.Call | None, owner: Scope | None) -> bool:
        """Return whether a call makes an instance: itself, or from the `__init__` of its class."""
        if value.call is not None and value.call is call:
            return True
        from_init = call is not None and isinstance(call.func, ast.Attribute) and call.func.attr == "__init__"
        return from_init and isinstance(value.of, OwnClass) and value.of.scope is owner


def _where(node: ast.AST, scope: Scope) -> Where:
    return Where(scope.module.file, getattr(node, "lineno", 0))


def _blocks(scope: Scope) -> Iterator[list[ast.stmt]]:
    """Yield every sequence of statements of a scope."""
    yield scope.node.body
    for node in scope.body:
        for name in ("body", "orelse", "finalbody"):
            block = getattr(node, name, None)
            if (
                isinstance(block, list)
                and block
                and not isinstance(node, ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef)
            ):
                yield block
