"""What an expression of a program can be, whatever the order in which the program runs."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import field, replace

from tuisim.base.data_class import dataclass
from tuisim.base.source import LIBRARIES
from tuisim.programs.robot import library
from tuisim.programs.robot.calls import Call, find_argument_node, find_default
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
    """Finds the values that expressions of a program can have, without running it."""

    modules: Mapping[str, Scope]
    """The program's own modules by name."""
    calls: Mapping[Function, Sequence[Call]] = field(default_factory=dict)
    """The known calls of each function."""
    _known: dict[tuple[ast.AST, Scope], tuple[Value, ...]] = field(default_factory=dict)
    _open: set[tuple[object, ...]] = field(default_factory=set)
    """Expressions and names that are being evaluated: ends the recursion of a program that refers to itself."""
    _steps: int = 0

    def values(self, node: ast.expr, scope: Scope) -> tuple[Value, ...]:
        """Return the values that an expression can have, the likeliest first; empty if nothing is known."""
        key = (node, scope)
        if key in self._known:
            return self._known[key]
        self._steps += 1
        if key in self._open or len(self._open) > MAX_DEPTH or self._steps > MAX_STEPS:
            return ()
        self._open.add(key)
        try:
            values = _drop_repeated(self._evaluate(node, scope))
        finally:
            self._open.discard(key)
        if not self._open:
            # The result is not cached inside another evaluation, where values may still be missing.
            self._known[key] = values
        return values

    def _evaluate(self, node: ast.expr, scope: Scope) -> Iterator[Value]:
        match node:
            case ast.Constant(value=str() | int() | float() | None as constant):
                yield constant
            case ast.Name(id=name):
                yield from self._read_name(name, scope)
            case ast.Attribute(value=base, attr=name):
                for value in self.values(base, scope):
                    yield from self.attribute(value, name)
            case ast.Subscript(value=base, slice=index):
                yield from self._read_item(base, index, scope)
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
                yield from self._compute(left, sign, right, scope)
            case ast.ListComp(elt=item) | ast.SetComp(elt=item) | ast.GeneratorExp(elt=item):
                # The items of a comprehension are alike, so one represents all.
                yield SourceCollection(ast.List([item]), scope)
            case ast.Call():
                yield from self._call(node, scope)

    def within(self, function: Function, call: Call) -> Evaluation:
        """Return an evaluation for one call of a function: its parameters have only the values of that call."""
        return Evaluation(self.modules, {**self.calls, function: [call]})

    # Names

    def _read_name(self, name: str, scope: Scope) -> Iterator[Value]:
        bindings = scope.find_bindings(name)
        for binding in bindings:
            yield from self._read_binding(binding)
        if not bindings:
            yield from self._read_stars(scope.top, name)

    def _read_stars(self, scope: Scope, name: str) -> Iterator[Value]:
        for module in scope.stars:
            yield from self._read_imported(module, name)

    def _read_binding(self, binding: Bound | Defined | Imported | Parameter) -> Iterator[Value]:
        match binding:
            case Bound():
                yield from self._read_bound(binding)
            case Defined(node=node, scope=scope):
                inner = scope.inner[node]
                yield (
                    OwnClass(inner) if isinstance(node, ast.ClassDef) else OwnFunction(node, inner)
                )
            case Imported(module=module, name=name):
                yield from self._read_imported(module, name) if name else self._read_module(module)
            case Parameter():
                for value, _ in self.arguments(binding):
                    yield value

    def _read_bound(self, bound: Bound) -> Iterator[Value]:
        for value in self.values(bound.node, bound.scope):
            values: list[Value] = [value]
            if bound.is_item:
                values = list(self._list_items(value))
            for index in bound.path:
                values = [inside for outer in values for inside in self._pick(outer, index)]
            yield from values

    def _read_module(self, name: str) -> Iterator[Value]:
        if name in self.modules:
            yield SourceModule(name)
        elif name.split(".")[0] in LIBRARIES:
            yield LibraryModule(name)

    def _read_imported(self, module: str, name: str) -> Iterator[Value]:
        key = ("module", module, name)
        if key in self._open:
            return
        self._open.add(key)
        try:
            for own in self._read_module(module):
                yield from self.attribute(own, name)
            if f"{module}.{name}" in self.modules:
                yield SourceModule(f"{module}.{name}")
        finally:
            self._open.discard(key)

    def attribute(self, value: Value, name: str) -> Iterator[Value]:
        """Yield the values that an attribute of a value can have."""
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
                    yield from self._read_name(name, scope)
                elif f"{module}.{name}" in self.modules:
                    yield SourceModule(f"{module}.{name}")
                else:
                    yield from self._read_stars(scope, name)
            case OwnClass(scope=scope):
                yield from self._read_class(scope, name, is_bound=False)
            case Instance(of=OwnClass(scope=scope), call=call):
                yield from _add_call(call, self._read_class(scope, name, is_bound=True))
            case LibraryClass(name=enumeration) if name in library.MEMBERS.get(enumeration, ()):
                yield library.MEMBERS[enumeration][name]
            case Instance(of=LibraryClass()) | LibraryClass() if name in library.CONSTANTS:
                yield library.CONSTANTS[name]
            case str() | int() | float() if name == "value":
                # A member of an enumeration is evaluated as its value, so its `value` is the same.
                yield value

    def _read_class(self, scope: Scope, name: str, *, is_bound: bool) -> Iterator[Value]:
        bindings = [*scope.names.get(name, ()), *scope.attributes.get(name, ())]
        for binding in bindings:
            for value in self._read_binding(binding):
                match value:
                    case OwnFunction():
                        yield replace(value, is_bound=is_bound)
                    case _:
                        yield value
        if not bindings:
            for base in self.bases(scope):
                if isinstance(base, OwnClass):
                    yield from self._read_class(base.scope, name, is_bound=is_bound)

    def bases(self, scope: Scope) -> list[Value]:
        """Return the possible values of the base classes of a class, which is given by its scope."""
        assert isinstance(scope.node, ast.ClassDef) and scope.outer is not None
        bases: list[Value] = []
        for base in scope.node.bases:
            # A class whose name is bound twice may seem to be its own base.
            bases += [value for value in self.values(base, scope.outer) if value != OwnClass(scope)]
        return bases

    def method(self, scope: Scope, name: str) -> OwnFunction | LibraryClass | None:
        """Return the method of a class: its own, or the one that it inherits; None if there is no such method.

        If the class inherits from a class of a library, which may define the method, the library's class is returned.

        Args:
            scope: The scope of the class.
            name: The name of the method.
        """
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

    def _list_items(self, value: Value) -> Iterator[Value]:
        if isinstance(value, SourceCollection):
            keys = [key for key in value.keys if key is not None]
            for item in keys or value.items:
                yield from self.values(item, value.scope)

    def _pick(self, value: Value, index: int) -> Iterator[Value]:
        if isinstance(value, SourceCollection) and not value.keys:
            items = value.items
            if isinstance(value.node, ast.List) and len(items) == 1 and index:
                index = 0
            if -len(items) <= index < len(items):
                yield from self.values(items[index], value.scope)

    def _read_item(self, base: ast.expr, index: ast.expr, scope: Scope) -> Iterator[Value]:
        keys = self.values(index, scope)
        for value in self.values(base, scope):
            if isinstance(value, SourceCollection):
                yield from self.look_up(value, keys)

    def look_up(self, table: SourceCollection, wanted_keys: Sequence[Value]) -> Iterator[Value]:
        """Yield the values that `table[key]` can have for each of some possible keys; all items if no key is known."""
        keys = table.keys
        for key, item in zip(keys or range(len(table.items)), table.items, strict=True):
            of_key = (
                self.values(key, table.scope)
                if isinstance(key, ast.expr)
                else (key, _count_index(key, table))
            )
            if (
                not wanted_keys
                or not of_key
                or any(wanted_key in of_key for wanted_key in wanted_keys)
            ):
                yield from self.values(item, table.scope)

    # Computed values

    def _compute(
        self, left: ast.expr, sign: ast.operator, right: ast.expr, scope: Scope
    ) -> Iterator[Value]:
        for first in self.values(left, scope):
            for other in self.values(right, scope):
                match first, other:
                    case (str(), str()) if isinstance(sign, ast.Add):
                        yield first + other
                    case (int() | float(), int() | float()) if type(sign) in OPERATORS and (
                        other or not isinstance(sign, ast.Div)
                    ):
                        yield OPERATORS[type(sign)](first, other)
                    case (str(), str() | int()) if (
                        isinstance(sign, ast.Mod) and first.count("%") == 1
                    ):
                        yield first.replace("%s", str(other)).replace("%d", str(other))

    def _call(self, node: ast.Call, scope: Scope) -> Iterator[Value]:
        match node.func:
            case ast.Name(id="super") if scope.owner is not None:
                yield Parent(scope.owner)
                return
            case ast.Name(id=name) if name in _CONVERTED and node.args:
                yield from self.values(node.args[0], scope)
                return
            case ast.Attribute(value=base, attr="get") if node.args:
                yield from self._call_get(base, node, scope)
        for value in self.values(node.func, scope):
            match value:
                case LibraryClass() | OwnClass():
                    yield Instance(value, node)
                case OwnFunction():
                    yield from _add_call(node, self.find_returned(value))

    def _call_get(self, base: ast.expr, node: ast.Call, scope: Scope) -> Iterator[Value]:
        """Yield the values that a call of `get` of a dict or of `os.environ` can return."""
        owners = self.values(base, scope)
        tables = [value for value in owners if isinstance(value, SourceCollection)]
        for table in tables:
            yield from self.look_up(table, self.values(node.args[0], scope))
        if len(node.args) > 1 and (tables or not owners):
            yield from self.values(node.args[1], scope)

    def find_returned(self, function: OwnFunction) -> Iterator[Value]:
        """Yield the values that a function of the program can return or yield."""
        for node in function.scope.body:
            if isinstance(node, ast.Return | ast.Yield) and node.value is not None:
                yield from self.values(node.value, function.scope)

    # Arguments

    def find_argument(self, call: Call, name: str, position: int | None) -> Sequence[Value] | None:
        """Return the values that a call gives for a parameter.

        The result is None if the call gives no value. It is empty if the value is unknown because of `*` or `**` in the
        call.

        Args:
            call: The call.
            name: The name of the parameter.
            position: Its index among the positional parameters; None if it is keyword-only.
        """
        if (node := find_argument_node(call, name, position)) is not None:
            return self.values(node, call.scope)
        is_unpacked = any(isinstance(argument, ast.Starred) for argument in call.node.args) or any(
            keyword.arg is None for keyword in call.node.keywords
        )
        return () if is_unpacked else None

    def arguments(self, parameter: Parameter) -> list[tuple[Value, Call | None]]:
        """Return the values that a parameter can have, each with the call that passes it.

        The call is None if no known call passes a value: then the value is the parameter's default, or the object for
        `self`.
        """
        name = parameter.argument.arg
        function = parameter.function
        owner = parameter.scope.outer
        arguments = [*function.args.posonlyargs, *function.args.args]
        names = [argument.arg for argument in arguments]
        if name in names[:1] and owner is not None and isinstance(owner.node, ast.ClassDef):
            return [(Instance(OwnClass(owner)), None)]
        key = (parameter,)
        if key in self._open:
            return []
        self._open.add(key)
        try:
            return self._find_arguments(parameter, names)
        finally:
            self._open.discard(key)

    def _find_arguments(
        self, parameter: Parameter, names: list[str]
    ) -> list[tuple[Value, Call | None]]:
        name = parameter.argument.arg
        owner = parameter.scope.outer
        default = find_default(parameter.function, name)
        usual: list[tuple[Value, Call | None]] = []
        if default is not None and owner is not None:
            usual = [(value, None) for value in self.values(default, owner)]
        values: list[tuple[Value, Call | None]] = []
        for call in self.calls.get(parameter.function, ()):
            position = names.index(name) - (1 if call.is_bound else 0) if name in names else None
            arguments = self.find_argument(call, name, position)
            if arguments is None:
                values += [(value, call) for value, _ in usual]
            else:
                values += [(value, call) for value in arguments]
        return values or usual


def _add_call(call: ast.Call | None, values: Iterable[Value]) -> Iterator[Value]:
    """Yield the values; in objects without the attribute `via`, set it to `call`, the call that makes them."""
    for value in values:
        yield (
            replace(value, via=call) if isinstance(value, Instance) and value.via is None else value
        )


def _count_index(index: object, table: SourceCollection) -> int:
    return index - len(table.items) if isinstance(index, int) else 0


def _drop_repeated(values: Iterable[Value]) -> tuple[Value, ...]:
    distinct: list[Value] = []
    for value in values:
        # 1, 1.0 and True are equal and count as one value here.
        if value not in distinct:
            distinct.append(value)
        if len(distinct) >= MAX_VALUES:
            break
    return tuple(distinct)
