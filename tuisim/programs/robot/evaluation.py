"""What an expression of a program can be, whatever the order in which the program runs."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import field, replace

from tuisim.base.data_class import dataclass
from tuisim.base.source import LIBRARIES
from tuisim.programs.robot import library
from tuisim.programs.robot.calls import Call, argument_node, find_default
from tuisim.programs.robot.scopes import (
    FUNCTIONS,
    Bound,
    Defined,
    Function,
    Imported,
    Parameter,
    Scope,
)
from tuisim.programs.robot.source import OPERATORS
from tuisim.programs.robot.values import (
    Instance,
    LibraryClass,
    LibraryModule,
    OwnClass,
    OwnFunction,
    Parent,
    SourceCollection,
    SourceModule,
    Value,
)

MAX_VALUES = 24
MAX_DEPTH = 40
MAX_STEPS = 20_000

_CONVERTED = {"str", "int", "float", "list", "tuple", "set", "sorted", "reversed", "iter", "const"}
"""Functions whose result is taken to be their argument."""


@dataclass(slots=True)
class Evaluation:
    """The expressions of one program."""

    modules: Mapping[str, Scope]
    """Its own modules by name."""
    calls: Mapping[Function, Sequence[Call]] = field(default_factory=dict)
    """The known calls of each function."""
    _known: dict[tuple[ast.AST, Scope], tuple[Value, ...]] = field(default_factory=dict)
    _open: set[tuple[object, ...]] = field(default_factory=set)
    """What is being evaluated, to end where a program refers to itself."""
    _steps: int = 0

    def values(self, node: ast.expr, scope: Scope) -> tuple[Value, ...]:
        """Return what an expression can be, the likeliest first; empty if nothing is known."""
        key = (node, scope)
        if key in self._known:
            return self._known[key]
        self._steps += 1
        if key in self._open or len(self._open) > MAX_DEPTH or self._steps > MAX_STEPS:
            return ()
        self._open.add(key)
        try:
            found = _distinct(self._of(node, scope))
        finally:
            self._open.discard(key)
        if not self._open:
            # Inside another evaluation it may lack what that one is about to find.
            self._known[key] = found
        return found

    def _of(self, node: ast.expr, scope: Scope) -> Iterator[Value]:
        match node:
            case ast.Constant(value=str() | int() | float() | None as constant):
                yield constant
            case ast.Name(id=name):
                yield from self._named(name, scope)
            case ast.Attribute(value=base, attr=name):
                for value in self.values(base, scope):
                    yield from self.attribute(value, name)
            case ast.Subscript(value=base, slice=index):
                yield from self._item(base, index, scope)
            case ast.List() | ast.Tuple() | ast.Set() | ast.Dict():
                yield SourceCollection(node, scope)
            case ast.IfExp(body=one, orelse=other):
                yield from (*self.values(one, scope), *self.values(other, scope))
            case ast.BoolOp(values=parts):
                for part in parts:
                    yield from (
                        value for value in self.values(part, scope) if value not in (None, "")
                    )
            case ast.NamedExpr(value=value) | ast.Await(value=value) | ast.Starred(value=value):
                yield from self.values(value, scope)
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                yield from (
                    -value
                    for value in self.values(operand, scope)
                    if isinstance(value, int | float)
                )
            case ast.BinOp(left=left, op=sign, right=right):
                yield from self._computed(left, sign, right, scope)
            case ast.ListComp(elt=item) | ast.SetComp(elt=item) | ast.GeneratorExp(elt=item):
                # Its items are alike: one stands for all.
                yield SourceCollection(ast.List([item]), scope)
            case ast.Call():
                yield from self._called(node, scope)

    def within(self, function: Function, call: Call) -> Evaluation:
        """Return the expressions of the same program as they are while one call of a function runs."""
        return Evaluation(self.modules, {**self.calls, function: [call]})

    # Names

    def _named(self, name: str, scope: Scope) -> Iterator[Value]:
        bindings = scope.find_bindings(name)
        for binding in bindings:
            yield from self._bound(binding)
        if not bindings:
            yield from self._from_stars(scope.top, name)

    def _from_stars(self, scope: Scope, name: str) -> Iterator[Value]:
        for module in scope.stars:
            yield from self._in_module(module, name)

    def _bound(self, binding: Bound | Defined | Imported | Parameter) -> Iterator[Value]:
        match binding:
            case Bound():
                yield from self._in_bound(binding)
            case Defined(node=node, scope=scope):
                inner = scope.inner[node]
                yield (
                    OwnClass(inner) if isinstance(node, ast.ClassDef) else OwnFunction(node, inner)
                )
            case Imported(module=module, name=name):
                yield from self._in_module(module, name) if name else self._module(module)
            case Parameter():
                for value, _ in self.arguments(binding):
                    yield value

    def _in_bound(self, bound: Bound) -> Iterator[Value]:
        for value in self.values(bound.node, bound.scope):
            found: list[Value] = [value]
            if bound.is_item:
                found = list(self._items(value))
            for at in bound.path:
                found = [inside for one in found for inside in self._at(one, at)]
            yield from found

    def _module(self, name: str) -> Iterator[Value]:
        if name in self.modules:
            yield SourceModule(name)
        elif name.split(".")[0] in LIBRARIES:
            yield LibraryModule(name)

    def _in_module(self, module: str, name: str) -> Iterator[Value]:
        key = ("module", module, name)
        if key in self._open:
            return
        self._open.add(key)
        try:
            for found in self._module(module):
                yield from self.attribute(found, name)
            if f"{module}.{name}" in self.modules:
                yield SourceModule(f"{module}.{name}")
            elif not module and name in self.modules:
                yield SourceModule(name)
        finally:
            self._open.discard(key)

    def attribute(self, value: Value, name: str) -> Iterator[Value]:
        """Yield what an attribute of a value can be."""
        match value:
            case LibraryModule(name=module) if module not in library.OTHER_HARDWARE:
                if name in library.CONSTANTS:
                    yield library.CONSTANTS[name]
                elif name in library.CLASSES:
                    yield LibraryClass(name)
                elif name.islower():
                    yield LibraryModule(f"{module}.{name}")
            case SourceModule(name=module):
                scope = self.modules[module]
                if name in scope.names:
                    yield from self._named(name, scope)
                elif f"{module}.{name}" in self.modules:
                    yield SourceModule(f"{module}.{name}")
                else:
                    yield from self._from_stars(scope, name)
            case OwnClass(scope=scope):
                yield from self._of_class(scope, name, is_bound=False)
            case Instance(of=OwnClass(scope=scope), call=call):
                yield from _made_by(call, self._of_class(scope, name, is_bound=True))
            case Parent(of=scope):
                for base in self.bases(scope):
                    if isinstance(base, OwnClass):
                        yield from self._of_class(base.scope, name, is_bound=True)
            case LibraryClass(name=enumeration) if name in library.MEMBERS.get(enumeration, ()):
                yield library.MEMBERS[enumeration][name]
            case Instance(of=LibraryClass()) | LibraryClass() if name in library.CONSTANTS:
                yield library.CONSTANTS[name]
            case str() | int() | float() if name == "value":
                # Of an enumeration: its members are taken to be their values.
                yield value

    def _of_class(self, scope: Scope, name: str, *, is_bound: bool) -> Iterator[Value]:
        bindings = [*scope.names.get(name, ()), *scope.attributes.get(name, ())]
        for binding in bindings:
            for value in self._bound(binding):
                match value:
                    case OwnFunction():
                        yield replace(value, is_bound=is_bound)
                    case _:
                        yield value
        if not bindings:
            for base in self.bases(scope):
                if isinstance(base, OwnClass):
                    yield from self._of_class(base.scope, name, is_bound=is_bound)
                elif isinstance(base, LibraryClass):
                    yield from self.attribute(base, name)

    def bases(self, scope: Scope) -> list[Value]:
        """Return the classes that a class is based on."""
        assert isinstance(scope.node, ast.ClassDef) and scope.outer is not None
        found: list[Value] = []
        for base in scope.node.bases:
            # One that is based on itself ends here.
            found += [value for value in self.values(base, scope.outer) if value != OwnClass(scope)]
        return found

    def method(self, scope: Scope, name: str) -> OwnFunction | LibraryClass | None:
        """Return the method that a class has or inherits; the class of the library that has it instead."""
        seen: set[Scope] = set()
        while scope not in seen:
            seen.add(scope)
            for binding in scope.names.get(name, ()):
                if isinstance(binding, Defined) and isinstance(binding.node, FUNCTIONS):
                    return OwnFunction(
                        binding.node, binding.scope.inner[binding.node], is_bound=True
                    )
            for base in self.bases(scope):
                if isinstance(base, LibraryClass):
                    return base
                if isinstance(base, OwnClass):
                    scope = base.scope
                    break
        return None

    # Parts of values

    def _items(self, value: Value) -> Iterator[Value]:
        if isinstance(value, SourceCollection):
            keys = [key for key in value.keys if key is not None]
            for item in keys or value.items:
                for inside in self.values(item, value.scope):
                    yield from self._items(inside) if isinstance(item, ast.Starred) else (inside,)

    def _at(self, value: Value, index: int) -> Iterator[Value]:
        if isinstance(value, SourceCollection) and not value.keys:
            items = value.items
            if isinstance(value.node, ast.List) and len(items) == 1 and index:
                index = 0
            if -len(items) <= index < len(items):
                yield from self.values(items[index], value.scope)

    def _item(self, base: ast.expr, index: ast.expr, scope: Scope) -> Iterator[Value]:
        wanted = self.values(index, scope)
        for value in self.values(base, scope):
            match value:
                case SourceCollection():
                    yield from self.looked_up(value, wanted)
                case OwnClass(scope=inner):
                    # An enumeration by name.
                    for name in wanted:
                        if isinstance(name, str):
                            yield from self._of_class(inner, name, is_bound=False)

    def looked_up(self, table: SourceCollection, wanted: Sequence[Value]) -> Iterator[Value]:
        """Yield what is in a table under one of these keys; everything if they are unknown."""
        keys = table.keys
        for key, item in zip(keys or range(len(table.items)), table.items, strict=True):
            of_key = (
                self.values(key, table.scope)
                if isinstance(key, ast.expr)
                else (key, _from_end(key, table))
            )
            if not wanted or not of_key or any(one in of_key for one in wanted):
                yield from self.values(item, table.scope)

    # Computed values

    def _computed(
        self, left: ast.expr, sign: ast.operator, right: ast.expr, scope: Scope
    ) -> Iterator[Value]:
        for one in self.values(left, scope):
            for other in self.values(right, scope):
                match one, other:
                    case (str(), str()) if isinstance(sign, ast.Add):
                        yield one + other
                    case (int() | float(), int() | float()) if type(sign) in OPERATORS and (
                        other or not isinstance(sign, ast.Div)
                    ):
                        yield OPERATORS[type(sign)](one, other)
                    case (str(), str() | int()) if (
                        isinstance(sign, ast.Mod) and one.count("%") == 1
                    ):
                        yield one.replace("%s", str(other)).replace("%d", str(other))

    def _called(self, node: ast.Call, scope: Scope) -> Iterator[Value]:
        match node.func:
            case ast.Name(id="super") if scope.owner is not None:
                yield Parent(scope.owner)
                return
            case ast.Name(id=name) if name in _CONVERTED and node.args:
                yield from self.values(node.args[0], scope)
                return
            case ast.Attribute(value=base, attr="get") if node.args:
                yield from self._of_get(base, node, scope)
        for value in self.values(node.func, scope):
            match value:
                case LibraryClass() | OwnClass():
                    yield Instance(value, node)
                case OwnFunction():
                    yield from _made_by(node, self.returned(value))

    def _of_get(self, base: ast.expr, node: ast.Call, scope: Scope) -> Iterator[Value]:
        """Yield what `get` of a dict returns, or of `os.environ`."""
        owners = self.values(base, scope)
        tables = [value for value in owners if isinstance(value, SourceCollection)]
        for table in tables:
            yield from self.looked_up(table, self.values(node.args[0], scope))
        if len(node.args) > 1 and (tables or not owners):
            yield from self.values(node.args[1], scope)

    def returned(self, function: OwnFunction) -> Iterator[Value]:
        """Yield what a function of the program can return or yield."""
        for node in function.scope.body:
            if isinstance(node, ast.Return | ast.Yield) and node.value is not None:
                yield from self.values(node.value, function.scope)

    # Arguments

    def find_argument(self, call: Call, name: str, at: int | None) -> Sequence[Value] | None:
        """Return what a call gives for a parameter; None if nothing, empty if unknown, as it is with `*…` and `**…`."""
        if (node := argument_node(call, name, at)) is not None:
            return self.values(node, call.scope)
        is_unpacked = any(isinstance(one, ast.Starred) for one in call.node.args) or any(
            keyword.arg is None for keyword in call.node.keywords
        )
        return () if is_unpacked else None

    def arguments(self, parameter: Parameter) -> list[tuple[Value, Call | None]]:
        """Return what a parameter can be, each with the call that says so; None for its default."""
        name = parameter.argument.arg
        function, owner = parameter.function, parameter.scope.outer
        arguments = [*function.args.posonlyargs, *function.args.args]
        names = [argument.arg for argument in arguments]
        if name in names[:1] and owner is not None and isinstance(owner.node, ast.ClassDef):
            return [(Instance(OwnClass(owner)), None)]
        key = (parameter,)
        if key in self._open:
            return []
        self._open.add(key)
        try:
            return self._arguments(parameter, names)
        finally:
            self._open.discard(key)

    def _arguments(self, parameter: Parameter, names: list[str]) -> list[tuple[Value, Call | None]]:
        name, owner = parameter.argument.arg, parameter.scope.outer
        default = find_default(parameter.function, name)
        usual: list[tuple[Value, Call | None]] = []
        if default is not None and owner is not None:
            usual = [(value, None) for value in self.values(default, owner)]
        found: list[tuple[Value, Call | None]] = []
        for call in self.calls.get(parameter.function, ()):
            at = names.index(name) - (1 if call.is_bound else 0) if name in names else None
            given = self.find_argument(call, name, at)
            if given is None:
                found += [(value, call) for value, _ in usual]
            else:
                found += [(value, call) for value in given]
        return found or usual


def _made_by(call: ast.Call | None, values: Iterable[Value]) -> Iterator[Value]:
    """Yield values with the call that makes them, where none nearer to them is known."""
    for value in values:
        yield (
            replace(value, via=call) if isinstance(value, Instance) and value.via is None else value
        )


def _from_end(index: object, table: SourceCollection) -> int:
    return index - len(table.items) if isinstance(index, int) else 0


def _distinct(values: Iterable[Value]) -> tuple[Value, ...]:
    found: list[Value] = []
    for value in values:
        # 1, 1.0 and True are equal, and stand for the same here.
        if value not in found:
            found.append(value)
        if len(found) >= MAX_VALUES:
            break
    return tuple(found)
