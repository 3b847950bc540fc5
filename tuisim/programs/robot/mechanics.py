"""What a program says about how its motors are mounted: reversed, with end stops, pressing a touch sensor."""

from __future__ import annotations

import ast
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import field

from tuisim.base.data_class import dataclass
from tuisim.programs.robot import library
from tuisim.programs.robot.calls import CallOrder, is_negated
from tuisim.programs.robot.end_stops import EndStop, Mechanics, StopPress, Target
from tuisim.programs.robot.evaluation import Evaluation
from tuisim.programs.robot.library import INVERSED, NORMAL, DeviceKind, Moves
from tuisim.programs.robot.mentions import Mentions, Pair, Where
from tuisim.programs.robot.scopes import FUNCTIONS, Bound, Scope, list_blocks
from tuisim.programs.robot.values import Instance, OwnClass, OwnFunction, Value
from tuisim.programs.robot.waiting_loops import (
    find_awaited_touch,
    find_state_test,
    find_stopped_motors,
)
from tuisim.programs.robot.words import is_forwards


def read_mechanics(mentions: Mentions) -> Mechanics:
    """Return how, according to a program, its motors are mounted and how far they move."""
    if mentions.evaluation is None:
        return Mechanics()
    evaluation = mentions.evaluation
    moves = library.MOVES[mentions.library]
    mechanics = Mechanics(CallOrder(evaluation.calls))
    return _MechanicsReader(mentions, evaluation, moves, mechanics).read()


@dataclass(slots=True)
class _MechanicsReader:
    mentions: Mentions
    evaluation: Evaluation
    moves: Moves
    """The moves of the program's library."""
    found: Mechanics
    normal: set[str] = field(default_factory=set)
    places: dict[str, set[float]] = field(default_factory=dict)
    """The positions that the program says its motors have, as at an end stop, by port."""
    targets: dict[str, list[Target]] = field(default_factory=dict)
    """The positions to which the program turns motors."""
    backwards: dict[str, Where] = field(default_factory=dict)
    """The motors that have negative speeds where the program says that it drives forwards."""
    inside: dict[ast.Call, Evaluation] = field(default_factory=dict)
    """Evaluations within objects, by the call that makes the object."""

    def read(self) -> Mechanics:
        for pair in self.mentions.pairs:
            if library.PAIRS[pair.class_name].reverses and pair.polarity != NORMAL:
                self._turn((pair.left, pair.right), INVERSED, pair.where)
        for device in self.mentions.devices:
            if device.is_turned:
                self._turn([device.port], INVERSED, device.where)
        for scope in self.mentions.scopes:
            for node in scope.body:
                self._read(node, scope)
            for block in list_blocks(scope):
                for before, statement in zip([None, *block], block, strict=False):
                    self._read_press([*([before] if before else []), statement], scope)
            if isinstance(scope.node, FUNCTIONS) and is_forwards(scope.node.name):
                self._read_forwards(scope)
        for port in self.normal:
            # A program that sets both polarities does not show how the motor is mounted.
            self.found.reversed.pop(port, None)
        for port, where in self.backwards.items():
            # If a motor with inversed polarity drives forwards at negative speed, it is mounted as usual.
            if self.found.reversed.pop(port, None) is None:
                self.found.reversed[port] = where
        for port in {**self.targets, **self.found.turns}:
            self.found.note_targets(port, self.targets.get(port, ()), self.places.get(port, ()))
        for port in {*self.found.reach_deg, *self.found.targets_deg}:
            if mention := self.mentions.find_motor(port):
                self.found.turn_motor(port, mention.gear_ratio, is_turned=mention.is_turned)
        return self.found

    def _read(self, node: ast.AST, scope: Scope) -> None:
        match node:
            case ast.Assign(targets=targets, value=value):
                for target in targets:
                    if isinstance(target, ast.Attribute):
                        self._read_assigned(target, value, scope)
            case ast.Call(func=ast.Attribute(value=base, attr="set_polarity"), args=[value, *_]):
                for text in self.evaluation.values(value, scope):
                    self._turn(self._find_known(base, scope), text, _find_where(node, scope))
            case ast.Attribute(value=base, attr="is_stalled"):
                self._stall(base, scope, node)
            case ast.While():
                for motor, is_sure in find_stopped_motors(node):
                    if is_sure or self._is_endless(motor, scope):
                        self._stall(motor, scope, node)
            case ast.Compare() | ast.Call() if test := find_state_test(node):
                if "stalled" in self.evaluation.values(test.state, scope):
                    self._stall(test.motor, scope, node, () if test.waits else None)
            case ast.Call(func=ast.Attribute(value=base, attr="wait_until_not_moving")):
                if self._is_endless(base, scope):
                    self._stall(base, scope, node, ())
            case ast.Call(func=ast.Attribute(value=base, attr=name)):
                self._read_call(node, name, base, scope)

    def _read_call(self, call: ast.Call, name: str, base: ast.expr, scope: Scope) -> None:
        """Record what a method call shows about a motor: a move, an end stop or a position.

        Args:
            call: The call.
            name: The name of the method.
            base: The expression for its object.
            scope: The scope that contains the call.
        """
        if name in self.moves.ending:
            self._note_reach(call, name, self._find_motors(base, scope), scope)
        elif name in self.moves.stalling:
            self.found.driven_to_stops.update(self._find_motors(base, scope))
            self._stall(
                base, scope, call, [speed > 0 for speed in self._find_speeds(call, scope) if speed]
            )
        elif name == "stalled":
            motor = (
                base.value if isinstance(base, ast.Attribute) and base.attr == "control" else base
            )
            self._stall(motor, scope, call)
        elif name == "reset_angle" and call.args:
            self._note_places(base, call.args[0], scope)

    def _read_assigned(self, target: ast.Attribute, value: ast.expr, scope: Scope) -> None:
        match target.attr:
            case "polarity":
                for text in self.evaluation.values(value, scope):
                    self._turn(
                        self._find_known(target.value, scope), text, _find_where(target, scope)
                    )
            case "position":
                self._note_places(target.value, value, scope)
            case "position_sp":
                self._note_targets(value, self._find_motors(target.value, scope), scope)

    def _note_places(self, base: ast.expr, value: ast.expr, scope: Scope) -> None:
        for port in self._find_motors(base, scope):
            self.places.setdefault(port, set()).update(self._find_numbers(value, scope))

    def _read_forwards(self, scope: Scope) -> None:
        """Record each motor that a function only turns backwards although its name says that it drives forwards."""
        speeds: dict[str, list[float]] = {}
        where: dict[str, Where] = {}
        for node in scope.body:
            if not (isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute)):
                continue
            if node.func.attr not in self.moves.endless | self.moves.ending - self.moves.unsigned:
                continue
            lengths = self._find_lengths(node, node.func.attr, scope)
            sign = -1 if is_negated(lengths) else 1
            if sign > 0 and any(
                length < 0
                for length_node in lengths
                for length in self._find_numbers(length_node, scope)
            ):
                return
            for port in self._find_known(node.func.value, scope):
                turned = [sign * speed for speed in self._find_speeds(node, scope)]
                speeds.setdefault(port, []).extend(turned)
                where.setdefault(port, _find_where(node, scope))
        for port, port_speeds in speeds.items():
            if port_speeds and max(port_speeds) < 0:
                self.backwards[port] = where[port]

    def _find_speeds(self, call: ast.Call, scope: Scope) -> Iterator[float]:
        """Yield the speeds in a call that moves one motor, or both motors of a pair."""
        assert isinstance(call.func, ast.Attribute)
        pairs = self._find_pairs(call.func.value, scope)
        first, last = (0, 1) if not pairs or call.func.attr in self.moves.of_both else (0, 2)
        if any(pair.class_name == "MoveSteering" for pair in pairs):
            first, last = 1, 2
        names = (*self.moves.speeds, "left_speed", "right_speed")
        named = [keyword.value for keyword in call.keywords if keyword.arg in names]
        for node in (*named, *call.args[first:last]):
            yield from self._find_numbers(
                node.args[0] if isinstance(node, ast.Call) and node.args else node, scope
            )

    def _find_lengths(self, call: ast.Call, name: str, scope: Scope) -> list[ast.expr]:
        """Return the argument expressions that say how far, or to which position, a call moves a motor."""
        named = [keyword.value for keyword in call.keywords if keyword.arg in self.moves.lengths]
        if name not in self.moves.length_at:
            return named
        assert isinstance(call.func, ast.Attribute)
        first = self.moves.length_at[name] + (1 if self._find_pairs(call.func.value, scope) else 0)
        return named + call.args[first : first + 1]

    def _find_numbers(self, node: ast.expr, scope: Scope) -> list[float]:
        return [
            value for value in self.evaluation.values(node, scope) if isinstance(value, int | float)
        ]

    def _turn(self, ports: Iterable[str], text: object, where: Where) -> None:
        for port in ports:
            if text == INVERSED:
                self.found.reversed.setdefault(port, where)
            elif text == NORMAL:
                self.normal.add(port)

    def _stall(
        self, base: ast.expr, scope: Scope, node: ast.AST, ways: Sequence[bool] | None = None
    ) -> None:
        """Record that a motor has an end stop, unless the program only prints whether the motor is stalled.

        If the program drives the motor against a stop in both directions, both end stops are recorded.

        Args:
            base: The expression for the motor.
            scope: The scope that contains it.
            node: The call or test that shows the end stop.
            ways: The directions in which the call can drive the motor, True for forwards; None to take the direction
                from the motor's other moves.
        """
        if ways is None and scope.prints(node):
            return
        for port in self._find_motors(base, scope):
            forwards = next(iter(ways or self._find_ways(scope.body, [port], scope)), None)
            stop = EndStop(_find_where(node, scope), self._convert_way(port, forwards), scope)
            known = self.found.stops.setdefault(port, stop)
            if any(self._convert_way(port, way) != known.forwards for way in ways or ()):
                self.found.closed.add(port)

    def _convert_way(self, port: str, forwards: bool | None) -> bool | None:
        """Return whether a move is forwards for the motor itself, which may be mounted in reverse; None if unknown.

        Args:
            port: The motor's port.
            forwards: Whether the move is forwards in the program; None if this is not known.
        """
        mention = self.mentions.find_motor(port)
        return not forwards if forwards is not None and mention and mention.is_turned else forwards

    # Movements

    def _find_calls(
        self, nodes: Iterable[ast.AST], ports: Iterable[str], names: Collection[str], scope: Scope
    ) -> list[ast.Call]:
        moved = {*ports}
        return [
            node
            for node in nodes
            if isinstance(node, ast.Call)
            and isinstance(node.func, ast.Attribute)
            and node.func.attr in names
            and moved & {*self._find_motors(node.func.value, scope)}
        ]

    def _moves(self, scope: Scope, ports: Iterable[str], names: Collection[str]) -> bool:
        return bool(self._find_calls(scope.body, ports, names, scope))

    def _is_endless(self, base: ast.expr, scope: Scope) -> bool:
        """Return whether the program moves a motor only by calls such as `run`, which start it without an end.

        The result is False if the program does not move the motor at all.
        """
        ports = self._find_motors(base, scope)
        return self._moves(scope, ports, self.moves.endless) and not self._moves(
            scope, ports, self.moves.ending
        )

    def _find_ways(
        self, nodes: Sequence[ast.AST], ports: Iterable[str], scope: Scope
    ) -> Iterator[bool]:
        """Yield whether a speed is forwards, for each speed that the program gives to one of the motors.

        Only calls without an end are considered, such as `motor.run(-200)`.

        Args:
            nodes: The nodes of the syntax tree.
            ports: The ports of the motors to consider.
            scope: The scope that contains the nodes.
        """
        ports = [*ports]
        for call in self._find_calls(nodes, ports, self.moves.endless, scope):
            named = [keyword.value for keyword in call.keywords if keyword.arg in self.moves.speeds]
            for node in (*named, *call.args[:1]):
                inside = node.args[0] if isinstance(node, ast.Call) and node.args else node
                yield from (value > 0 for value in self._find_numbers(inside, scope) if value)
        for statement in nodes:
            match statement:
                case ast.Assign(targets=[ast.Attribute(value=base, attr=name)], value=speed) if (
                    name in self.moves.speeds
                ):
                    if {*ports} & {*self._find_motors(base, scope)}:
                        yield from (
                            value > 0 for value in self._find_numbers(speed, scope) if value
                        )

    def _note_reach(self, call: ast.Call, name: str, ports: Sequence[str], scope: Scope) -> None:
        turns = 360.0 if name == "on_for_rotations" else 1.0
        for node in self._find_lengths(call, name, scope):
            if name in self.moves.unsigned:
                self._note_targets(node, ports, scope)
                continue
            lengths = self._find_numbers(node, scope)
            self.found.endless.update(() if lengths else ports)
            for length in lengths:
                turn = Target(abs(length) * turns, _find_where(node, scope), scope)
                for port in ports:
                    self.found.note_turn(port, turn)

    def _note_targets(self, node: ast.expr, ports: Sequence[str], scope: Scope) -> None:
        targets = self._find_numbers(node, scope)
        if not targets:
            self.found.endless.update(ports)
            return
        for port in ports:
            where = _find_where(node, scope)
            self.targets.setdefault(port, []).extend(Target(deg, where, scope) for deg in targets)

    # Touch sensors

    def _read_press(self, statements: list[ast.stmt], scope: Scope) -> None:
        """Record that a motor presses a touch sensor, if statements run the motor until the sensor is pressed.

        The last statement must wait for the press, and no other motor may move in the statements.
        """
        last = statements[-1]
        base = find_awaited_touch(last)
        if base is None:
            return
        touches = self._find_ports(base, scope, DeviceKind.TOUCH)
        nodes = [inner for statement in statements for inner in ast.walk(statement)]
        moved = {
            port
            for node in nodes
            if isinstance(node, ast.Call)
            and isinstance(node.func, ast.Attribute)
            and node.func.attr in self.moves.endless | self.moves.ending
            for port in self._find_motors(node.func.value, scope)
        }
        if len(moved) == 1 and touches:
            forwards = next(self._find_ways([*nodes, *scope.body], moved, scope), None)
            motor = moved.pop()
            stop = EndStop(_find_where(last, scope), self._convert_way(motor, forwards), scope)
            self.found.presses.append(StopPress(touches[0], motor, stop))

    # Devices

    def _find_known(self, node: ast.expr, scope: Scope) -> list[str]:
        """Return the ports of the motors that an expression may stand for.

        The result is empty if the expression stands for several motors in turn, as the variable of a loop does.
        """
        in_turn = any(
            value.call and sum(device.call is value.call for device in self.mentions.devices) > 1
            for value in self.evaluation.values(node, scope)
            if isinstance(value, Instance)
        )
        if in_turn:
            return []
        return [port for item in scope.list_items(node) for port in self._find_motors(item, scope)]

    def _find_motors(self, node: ast.expr, scope: Scope) -> list[str]:
        return self._find_ports(node, scope, DeviceKind.LARGE, DeviceKind.MEDIUM, DeviceKind.MOTOR)

    def _find_ports(self, node: ast.expr, scope: Scope, *kinds: DeviceKind) -> list[str]:
        """Return the ports of the devices of given kinds that an expression may stand for."""
        match node:
            case ast.Attribute(value=base, attr="left_motor" | "right_motor" as side):
                if pairs := self._find_pairs(base, scope):
                    return [getattr(pair, side.removesuffix("_motor")) for pair in pairs]
        ports = [port for pair in self._find_pairs(node, scope) for port in (pair.left, pair.right)]
        ports += [
            device.port
            for value in self._evaluate(node, scope)
            for device in self.mentions.devices
            if isinstance(value, Instance) and device.kind in kinds and device.makes(value)
        ]
        return list(dict.fromkeys(ports))

    def _evaluate(self, node: ast.expr, scope: Scope) -> Sequence[Value]:
        """Return the values that an expression can have in its line.

        A variable with several assignments has the value of the nearest one above. An attribute of an object of the
        program is evaluated within this object.

        Args:
            node: The expression.
            scope: The scope that contains it.
        """
        match node:
            case ast.Name(id=name):
                known = [
                    bound
                    for bound in scope.names.get(name, ())
                    if isinstance(bound, Bound) and bound.scope is scope
                ]
                above = [
                    bound
                    for bound in known
                    if bound.node.lineno < node.lineno and not (bound.path or bound.is_item)
                ]
                if len(known) > 1 and above:
                    return self._evaluate(
                        max(above, key=lambda bound: bound.node.lineno).node, scope
                    )
            case ast.Attribute(value=base, attr=name):
                of = self._evaluate(base, scope)
                if any(isinstance(bound, Instance) for bound in of):
                    return [
                        value
                        for bound in of
                        for value in self._enter_object(bound).attribute(bound, name)
                    ]
        return self.evaluation.values(node, scope)

    def _enter_object(self, value: Value) -> Evaluation:
        """Return an evaluation of expressions within one object, whose class is one of the program."""
        match value:
            case Instance(of=OwnClass(scope=scope), call=ast.Call() as call):
                if call not in self.inside:
                    self.inside[call] = self.evaluation
                    if isinstance(init := self.evaluation.method(scope, "__init__"), OwnFunction):
                        for init_call in self.evaluation.calls.get(init.node, ()):
                            if init_call.node is call:
                                self.inside[call] = self.evaluation.within(init.node, init_call)
                return self.inside[call]
        return self.evaluation

    def _find_pairs(self, node: ast.expr, scope: Scope) -> list[Pair]:
        pairs = []
        for value in self.evaluation.values(node, scope):
            if isinstance(value, Instance):
                pairs += [pair for pair in self.mentions.pairs if pair.makes(value)]
        return pairs


def _find_where(node: ast.AST, scope: Scope) -> Where:
    return Where(scope.module.file, getattr(node, "lineno", 0))
