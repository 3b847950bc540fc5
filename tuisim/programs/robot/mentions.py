"""The devices that a program makes: their kinds and ports, and what it says about them."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import field, replace

from tuisim.base.data_class import dataclass
from tuisim.engine.core.profile import Library
from tuisim.programs.robot import library
from tuisim.programs.robot.calls import Call, find_argument_node
from tuisim.programs.robot.evaluation import Evaluation
from tuisim.programs.robot.library import DeviceKind, PairClass
from tuisim.programs.robot.reach import find_reachable, find_skipped
from tuisim.programs.robot.scopes import FUNCTIONS, Function, Scope, build_scope
from tuisim.programs.robot.source import Module, find_hub, find_library
from tuisim.programs.robot.values import (
    Instance,
    LibraryClass,
    OwnClass,
    OwnFunction,
    Parent,
    SourceCollection,
    Value,
    is_number,
)

_ROUNDS = 3
"""How often the calls are looked up: each time more is known about what is called."""
_MAX_WAYS = 40
"""Functions with more calls than these are read for all of them at once."""


@dataclass(frozen=True, slots=True)
class Where:
    """The place of something in a program: a file and a line number."""

    file: str
    line: int

    def __str__(self) -> str:
        return f"{self.file}, line {self.line}"


@dataclass(frozen=True, slots=True)
class Mention:
    """A device that a program creates, with its port and the names that the program gives it."""

    kind: DeviceKind
    port: str
    """Its short name, such as `outA`; empty if the program does not say it."""
    where: Where
    names: tuple[str, ...] = ()
    """The program's names for the device, the nearest one first."""
    owner: Scope | None = None
    """The class in which it is made."""
    is_any: bool = False
    """Whether the program takes any device of the kind; else its port is not known."""
    call: ast.Call | None = None
    """The call that makes the device."""
    via: ast.Call | None = field(default=None, compare=False)
    """The call of the function in which it is made, if that has several."""
    is_turned: bool = False
    """Whether the program makes the motor with the opposite direction as the positive one."""
    gear_ratio: float = 1.0
    """Turns of the motor per turn of what it drives, as the program says."""

    def makes(self, value: Instance) -> bool:
        """Return whether an object in the program is this device, because the same call created both.

        If the object's class is one of the program that inherits from the device's class, the call
        `super().__init__(port)` in it counts as this call.
        """
        return _is_maker(self.call, self.owner, value)


@dataclass(frozen=True, slots=True)
class Pair:
    """Two motors that a program drives together through one object."""

    left: str
    right: str
    """Their ports."""
    kind: DeviceKind
    rank: int
    """The higher, the likelier these are the wheels."""
    where: Where
    class_name: str
    wheel_mm: tuple[float, float | None] | None = None
    """Diameter and width; the width is None if it does not say that."""
    spacing_mm: float | None = None
    names: tuple[str, ...] = ()
    call: ast.Call | None = None
    """The call that makes the pair."""
    owner: Scope | None = None
    """The class in which it is made."""
    polarity: str = ""
    """The polarity that the program gives for the motors, for a class that takes one."""

    def makes(self, value: Instance) -> bool:
        """Return whether an object in the program is this pair of motors, because the same call created both.

        If the object's class is one of the program that inherits from the pair's class, the call
        `super().__init__(left, right)` in it counts as this call.
        """
        return _is_maker(self.call, self.owner, value)


@dataclass(frozen=True, slots=True)
class Mentions:
    """The devices that a program creates, and the code that may show more about them."""

    devices: tuple[Mention, ...] = ()
    pairs: tuple[Pair, ...] = ()
    scopes: Sequence[Scope] = ()
    """The scopes of the program that can run."""
    evaluation: Evaluation | None = None
    """Finds out what the program's expressions can be."""
    library: Library = Library.EV3DEV2
    """The library that it uses."""
    hub: str = ""
    """The hub that it is for, one of `HUBS`, on whose ports it names motors and sensors; empty for the EV3."""

    def find_motor(self, port: str) -> Mention | None:
        """Return the first motor that the program creates on a port; None if there is none."""
        return next(
            (device for device in self.devices if device.port == port and device.kind.is_motor),
            None,
        )


def read_mentions(modules: dict[str, Module]) -> Mentions:
    """Return the devices that a program and its own modules create."""
    scopes = {name: build_scope(module) for name, module in modules.items()}
    hub = find_hub(modules)
    mentions = _Reader(scopes, hub).read()
    if hub:
        devices = tuple(replace(part, port=part.port[-1:]) for part in mentions.devices)
        pairs = tuple(
            replace(part, left=part.left[-1:], right=part.right[-1:]) for part in mentions.pairs
        )
        mentions = replace(mentions, devices=devices, pairs=pairs, hub=hub)
    return replace(mentions, library=find_library(modules) or mentions.library)


@dataclass(slots=True)
class _Reader:
    modules: dict[str, Scope]
    hub: str
    """As `Mentions.hub`."""
    scopes: list[Scope] = field(init=False)
    evaluation: Evaluation = field(init=False)
    made: list[tuple[str, Call]] = field(init=False, default_factory=list)
    """Each class of the library with a call that makes one of it."""
    parts: set[ast.AST] = field(init=False, default_factory=set)
    """The calls in `made`."""
    hints: dict[ast.AST, list[str]] = field(init=False, default_factory=dict)
    via: Call | None = field(init=False, default=None)
    """The call of the function that is being read, if it has several."""

    def read(self) -> Mentions:
        self.scopes = find_reachable(self.modules)
        calls = [Call(node, scope) for scope in self.scopes for node in _list_calls(scope)]
        self.evaluation = Evaluation(self.modules)
        for _ in range(_ROUNDS):
            sorted_calls: dict[Function, list[Call]] = {}
            self.made = []
            for call in calls:
                self._sort(call, sorted_calls)
            if sorted_calls == self.evaluation.calls:
                break
            self.evaluation = Evaluation(self.modules, sorted_calls)
        self.parts = {call.node for _, call in self.made}
        for scope in self.scopes:
            self._note_names(scope)
        devices: list[Mention] = []
        pairs: list[Pair] = []
        whole = self.evaluation
        of_ports = [pair for pair in self.made if not _needs_motors(pair[0])]
        # Classes that take motors are read last, when the motors are known.
        for name, call in (*of_ports, *(pair for pair in self.made if _needs_motors(pair[0]))):
            for inside, via in self._list_ways(name, call, whole):
                self.evaluation = inside
                self.via = via
                if name in library.PAIRS:
                    pairs += self._find_pairs(name, call, devices)
                    devices += self._list_needs(name, call)
                elif name == library.MOTOR_SET:
                    devices += self._read_set(call)
                elif name in library.DEVICES:
                    devices += self._find_devices(name, call)
        self.evaluation = whole
        # A call with a known port replaces the same one without: recursive calls may lack the port.
        known = {pair.call for pair in devices if pair.port}
        devices = [pair for pair in devices if pair.port or pair.is_any or pair.call not in known]
        return Mentions(
            tuple(dict.fromkeys(devices)), tuple(dict.fromkeys(pairs)), self.scopes, whole
        )

    def _list_ways(
        self, name: str, call: Call, whole: Evaluation
    ) -> Iterator[tuple[Evaluation, Call | None]]:
        """Yield an evaluation for each call of the function in which a device is created, together with the call.

        The evaluation finds the values of expressions with the arguments of this call. If the function is called at
        most once, or more than `_MAX_WAYS` times, yield only `whole` and None.

        Args:
            name: The library class of the device.
            call: The call that creates the device.
            whole: The evaluation of the whole program.
        """
        function = call.scope.node
        calls = whole.calls.get(function, ()) if isinstance(function, FUNCTIONS) else ()
        if not 1 < len(calls) <= _MAX_WAYS or not isinstance(function, FUNCTIONS):
            yield whole, None
            return
        for via in calls:
            inside = whole.within(function, via)
            values = inside.values(call.node.func, call.scope)
            # If the function gets the class as an argument, only the calls that pass this class are yielded.
            if (
                not any(isinstance(value, LibraryClass) for value in values)
                or LibraryClass(name) in values
            ):
                yield inside, via

    # Calls

    def _sort(self, call: Call, calls: dict[Function, list[Call]]) -> None:
        """Record a call by the function or class that it calls, which is one of the program or a class of the library.

        Args:
            call: The call.
            calls: The calls of each function of the program, to which the call is added.
        """
        match call.node.func:
            case ast.Attribute(value=base, attr="__init__"):
                for value in self.evaluation.values(base, call.scope):
                    self._sort_init(value, call, calls)
                return
        for value in self.evaluation.values(call.node.func, call.scope):
            match value:
                case LibraryClass(name=name):
                    self.made.append((name, call))
                case OwnClass(scope=scope):
                    self._sort_class(scope, call, calls)
                case OwnFunction(node=node, is_bound=is_bound):
                    calls.setdefault(node, []).append(replace(call, is_bound=is_bound))

    def _sort_init(self, value: Value, call: Call, calls: dict[Function, list[Call]]) -> None:
        """Record a call such as `super().__init__()` or `Base.__init__(self)` as a call of the base class.

        Args:
            value: The object before `.__init__`.
            call: The call.
            calls: The calls of each function of the program, to which the call is added.
        """
        match value:
            case Parent(of=scope):
                for base in self.evaluation.bases(scope):
                    if isinstance(base, LibraryClass):
                        self.made.append((base.name, call))
                    elif isinstance(base, OwnClass):
                        self._sort_class(base.scope, call, calls)
            case LibraryClass() | OwnClass() if call.node.args:
                node = ast.copy_location(
                    ast.Call(call.node.func, call.node.args[1:], call.node.keywords), call.node
                )
                rest = Call(node, call.scope)
                if isinstance(value, LibraryClass):
                    self.made.append((value.name, rest))
                else:
                    self._sort_class(value.scope, rest, calls)

    def _sort_class(self, scope: Scope, call: Call, calls: dict[Function, list[Call]]) -> None:
        match self.evaluation.method(scope, "__init__"):
            case OwnFunction(node=node):
                calls.setdefault(node, []).append(replace(call, is_bound=True))
            case LibraryClass(name=name):
                self.made.append((name, call))

    # Names

    def _note_names(self, scope: Scope) -> None:
        for node in scope.body:
            match node:
                case ast.Assign(targets=targets, value=value):
                    for target in targets:
                        self._note(target, value)
                case (
                    ast.AnnAssign(target=target, value=ast.expr() as value)
                    | ast.NamedExpr(target=target, value=value)
                ):
                    self._note(target, value)
                case ast.Dict(keys=keys, values=values):
                    for key, value in zip(keys, values, strict=True):
                        if isinstance(key, ast.Constant) and isinstance(key.value, str):
                            self._note_hint(value, key.value)
                case ast.keyword(arg=str(name), value=value):
                    self._note_hint(value, name)
                case ast.Return(value=ast.expr() as value) if isinstance(scope.node, FUNCTIONS):
                    self._note_hint(value, scope.node.name)
        for function, calls in self.evaluation.calls.items():
            for call in calls:
                if call.scope is scope:
                    names = [argument.arg for argument in function.args.args][
                        1 if call.is_bound else 0 :
                    ]
                    for name, value in zip(names, call.node.args, strict=False):
                        self._note_hint(value, name)

    def _note(self, target: ast.expr, value: ast.expr) -> None:
        match target, value:
            case (
                ast.Tuple(elts=targets) | ast.List(elts=targets),
                ast.Tuple(elts=values) | ast.List(elts=values),
            ):
                for part, inside in zip(targets, values, strict=False):
                    self._note(part, inside)
            case ((ast.Name(id=name) | ast.Attribute(attr=name)), _):
                self._note_hint(value, name)

    def _note_hint(self, value: ast.expr, name: str) -> None:
        if name not in (known := self.hints.setdefault(value, [])):
            known.append(name)
        match value:
            case ast.Call(args=args):
                # In `elbow = Joint(LargeMotor(OUTPUT_B))`, the motor gets the name of the object that it is a part of.
                parts = [part for part in args if part in self.parts]
                if len(parts) == 1 and value not in self.parts:
                    self._note_hint(parts[0], name)

    # Devices

    def _find_devices(self, name: str, call: Call) -> Iterator[Mention]:
        kind = self._find_kind(name, call)
        if kind is None:
            return
        word = next(
            (one.arg for one in call.node.keywords if one.arg in library.PORT_NAMES),
            library.PORT_NAMES[0],
        )
        node = find_argument_node(call, word, 0)
        names = self._find_names(call)
        device = Mention(
            kind,
            "",
            _find_where(call),
            names,
            call.scope.owner,
            call=call.node,
            via=self.via.node if self.via else None,
        )
        if name in library.WITHOUT_PORT:
            yield replace(device, is_any=True)
            return
        values = self.evaluation.find_argument(call, word, 0) or ()
        ports = self._find_ports(call, word, 0)
        if not ports and not any(isinstance(value, str) for value in values):
            # A text other than a port names a device that is not simulated, so only calls without texts are kept.
            is_any = node is None or (isinstance(node, ast.Constant) and node.value is None)
            yield replace(device, is_any=is_any)
        for port in ports:
            if not self.hub and port.startswith("out") != kind.is_motor:
                continue
            called = (*names, *(library.list_names(node) if node is not None else ()))
            placed = replace(device, port=port, names=called)
            yield self._mount(placed, call) if kind.is_motor else placed

    def _mount(self, motor: Mention, call: Call) -> Mention:
        """Return a motor, completed with the direction and the gear ratio from the call that creates it."""
        is_turned = library.INVERSED in (
            self.evaluation.find_argument(call, library.DIRECTION, 1) or ()
        )
        return replace(motor, is_turned=is_turned, gear_ratio=self._read_gears(call))

    def _read_gears(self, call: Call) -> float:
        """Return a motor's turns per turn of the axle that it drives, from the list of gears in a call.

        The result is 1.0 if the call has no list of gears.
        """
        parts = [*self._flatten(self.evaluation.find_argument(call, library.GEARS, 2) or ())]
        trains = [
            [*self._flatten([part])] for part in parts if isinstance(part, SourceCollection)
        ] or [parts]
        ratio = 1.0
        for train in trains:
            teeth = [count for count in train if isinstance(count, int | float) and count > 0]
            if len(teeth) > 1:
                ratio *= teeth[-1] / teeth[0]
        return ratio

    def _find_names(self, call: Call) -> tuple[str, ...]:
        """Return the program's names for the object that a call creates."""
        outside = self.hints.get(self.via.node, ()) if self.via else ()
        return tuple(dict.fromkeys((*self.hints.get(call.node, ()), *outside)))

    def _find_ports(self, call: Call, name: str, position: int) -> list[str]:
        """Return the ports that an argument of a call may name, the likeliest first.

        Args:
            call: The call that creates the device.
            name: The name of the parameter.
            position: The index of the parameter.
        """
        values = self.evaluation.find_argument(call, name, position) or ()
        return list(dict.fromkeys(filter(None, map(library.parse_port, values))))

    def _flatten(self, values: Sequence[Value]) -> Iterator[Value]:
        for value in values:
            if isinstance(value, SourceCollection):
                for item in value.items:
                    yield from self.evaluation.values(item, value.scope)
            else:
                yield value

    def _find_kind(self, name: str, call: Call) -> DeviceKind | None:
        """Return the kind of a device that a call creates; None if the driver that it names is not simulated."""
        if driver := self.evaluation.find_argument(call, "driver_name", None):
            return library.find_driver_kind(next(self._flatten(driver), None))
        kind = library.DEVICES[name]
        return self._find_mode_kind(call) or kind if kind is DeviceKind.SENSOR else kind

    def _find_mode_kind(self, call: Call) -> DeviceKind | None:
        """Return the kind of a sensor from the mode that the program sets; None if it sets no mode."""
        names = self.hints.get(call.node, ())
        for scope in self.scopes:
            for node in scope.body:
                match node:
                    case ast.Assign(
                        targets=[
                            ast.Attribute(
                                value=ast.Name(id=name) | ast.Attribute(attr=name), attr="mode"
                            )
                        ],
                        value=mode,
                    ) if name in names:
                        for value in self.evaluation.values(mode, scope):
                            if kind := library.find_mode_kind(value):
                                return kind
        return None

    def _read_set(self, call: Call) -> Iterator[Mention]:
        owner = call.scope.owner
        where = _find_where(call)
        for table in self.evaluation.find_argument(call, "motor_specs", 0) or ():
            if isinstance(table, SourceCollection) and isinstance(table.node, ast.Dict):
                for key, item in zip(table.keys, table.items, strict=True):
                    ports = self.evaluation.values(key, table.scope) if key is not None else ()
                    kinds = [
                        kind
                        for value in self.evaluation.values(item, table.scope)
                        if (kind := _find_motor_kind(value))
                    ]
                    for port in map(library.parse_port, ports):
                        if port and kinds:
                            names = library.list_names(key) if key is not None else ()
                            yield Mention(
                                kinds[0],
                                port,
                                where,
                                (*names, *self._find_names(call)),
                                owner,
                                call=call.node,
                            )

    # Pairs

    def _find_pairs(self, name: str, call: Call, devices: Sequence[Mention]) -> Iterator[Pair]:
        """Yield the pairs of motors that a call creates.

        Args:
            name: The name of the class that is called.
            call: The call.
            devices: The devices that the program creates, among them the motors for a class that takes motors.
        """
        known = library.PAIRS[name]
        names = self._find_names(call)
        polarities = [
            str(value) for value in self.evaluation.find_argument(call, library.POLARITY, 2) or ()
        ]
        for left, other in self._find_ends(known, call, devices):
            if left != other and left.startswith("out") and other.startswith("out"):
                yield Pair(
                    left,
                    other,
                    self._read_motor_kind(name, known, call),
                    known.rank,
                    _find_where(call),
                    name,
                    *self._read_sizes(known, call),
                    names,
                    call.node,
                    call.scope.owner,
                    polarities[0] if polarities else "",
                )

    def _find_ends(
        self, known: PairClass, call: Call, devices: Sequence[Mention]
    ) -> Iterable[tuple[str, str]]:
        """Return a tuple of the left and the right motor's port for each pair that a call can create.

        Args:
            known: The library class of the pair.
            call: The call.
            devices: The devices that the program creates.
        """
        if known.takes_motors:
            left, right = (
                self._find_driven(call, known.left, 0, devices),
                self._find_driven(call, known.right, 1, devices),
            )
            if len(left) == 2 and right in ([], left):
                # With `motors = [Motor(port) for port in ports]`, `motors[0]` and `motors[1]` can each be both ports:
                # the ports are taken in order.
                left, right = left[:1], left[1:]
        else:
            # `GyroBalancer` alone has usual ports; its motor ports are the arguments 10 and 11, counted from 0.
            places = (10, 11) if known.usual[0] else (0, 1)
            left = self._find_ports(call, known.left, places[0])
            right = self._find_ports(call, known.right, places[1])
        left = left or ([known.usual[0]] if known.usual[0] else [])
        right = right or ([known.usual[1]] if known.usual[1] else [])
        if len(left) != len(right):
            left, right = left[:1], right[:1]
        return dict.fromkeys(zip(left, right, strict=False))

    def _find_driven(self, call: Call, name: str, at: int, devices: Sequence[Mention]) -> list[str]:
        """Return the ports of the motors that may be the value of an argument of a call.

        Args:
            call: The call.
            name: The name of the parameter.
            at: The index of the parameter.
            devices: The devices that the program creates.
        """
        instances = [
            one
            for one in self.evaluation.find_argument(call, name, at) or ()
            if isinstance(one, Instance)
        ]
        makers = [
            (one, value)
            for value in instances
            for one in devices
            if one.kind.is_motor and one.makes(value)
        ]
        return list(
            dict.fromkeys(
                one.port
                for one, value in makers
                if value.via is None or one.via in (None, value.via)
            )
        )

    def _read_sizes(
        self, known: PairClass, call: Call
    ) -> tuple[tuple[float, float | None] | None, float | None]:
        """Return diameter and width of the wheels, and their distance, in mm.

        A size that the call does not give is None.
        """
        if known.takes_motors:
            diameter_mm = self._read_size(call, library.WHEEL_DIAMETER, 2)
            wheel_mm = (diameter_mm, None) if diameter_mm is not None else None
            return wheel_mm, self._read_size(call, library.AXLE_TRACK, 3)
        return (
            (self._read_wheel(call), self._read_size(call, library.DISTANCE, 3))
            if known.rank == 3
            else (None, None)
        )

    def _read_size(self, call: Call, name: str, position: int) -> float | None:
        values = self.evaluation.find_argument(call, name, position) or ()
        return next((float(value) for value in values if isinstance(value, int | float)), None)

    def _read_motor_kind(self, name: str, known: PairClass, call: Call) -> DeviceKind:
        values = self.evaluation.find_argument(
            call, library.MOTOR_CLASS, library.MOTOR_CLASS_INDEX.get(name)
        )
        return next(
            (kind for value in values or () if (kind := _find_motor_kind(value))), known.kind
        )

    def _read_wheel(self, call: Call) -> tuple[float, float] | None:
        for value in self.evaluation.find_argument(call, library.WHEEL_CLASS, 2) or ():
            if size := self._find_size(value, ()):
                return size
        return None

    def _find_size(self, wheel: Value, seen: tuple[Value, ...]) -> tuple[float, float] | None:
        match wheel:
            case LibraryClass(name=name):
                return library.WHEELS.get(name)
            case OwnClass(scope=scope) if wheel not in seen:
                for name, call in self.made:
                    if name == library.WHEEL and call.scope.owner is scope:
                        sizes = [
                            [
                                number
                                for number in self.evaluation.find_argument(call, key, place) or ()
                                if is_number(number)
                            ]
                            for place, key in enumerate(("diameter_mm", "width_mm"))
                        ]
                        if all(sizes):
                            return float(str(sizes[0][0])), float(str(sizes[1][0]))
                for base in self.evaluation.bases(scope):
                    if size := self._find_size(base, (*seen, wheel)):
                        return size
        return None

    def _list_needs(self, name: str, call: Call) -> Iterator[Mention]:
        for kind in library.PAIRS[name].needs:
            yield Mention(kind, "", _find_where(call), is_any=True)


def _list_calls(scope: Scope) -> list[ast.Call]:
    left_out = find_skipped(scope)
    return [node for node in scope.body if isinstance(node, ast.Call) and node not in left_out]


def _needs_motors(name: str) -> bool:
    return name in library.PAIRS and library.PAIRS[name].takes_motors


def _is_maker(call: ast.Call | None, owner: Scope | None, value: Instance) -> bool:
    """Return whether a call created an object.

    This is also true of a call such as `super().__init__()` in the class of the object.

    Args:
        call: The call.
        owner: The scope of the class that contains the call; None outside classes.
        value: The object.
    """
    if value.call is not None and value.call is call:
        return True
    from_init = (
        call is not None and isinstance(call.func, ast.Attribute) and call.func.attr == "__init__"
    )
    return from_init and isinstance(value.of, OwnClass) and value.of.scope is owner


def _find_where(call: Call) -> Where:
    return Where(call.scope.module.file, call.node.lineno)


def _find_motor_kind(value: Value) -> DeviceKind | None:
    """Return the kind of motor of a library class; None for other values."""
    kind = library.DEVICES.get(value.name) if isinstance(value, LibraryClass) else None
    return kind if kind and kind.is_motor else None
