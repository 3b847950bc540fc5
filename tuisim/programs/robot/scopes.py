"""What the names in a program are bound to, scope by scope, in whatever order it would bind them."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import field
from typing import TypeAlias

from tuisim.base.data_class import dataclass
from tuisim.programs.robot.source import Module

Function: TypeAlias = ast.FunctionDef | ast.AsyncFunctionDef
FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef)
UNITS = (*FUNCTIONS, ast.ClassDef)


@dataclass(frozen=True, slots=True)
class Bound:
    """A binding of a name to an expression."""

    node: ast.expr
    scope: Scope
    path: tuple[int, ...] = ()
    """Where in the value, for `a, b = …`."""
    is_item: bool = False
    """Whether it is bound to each item of the value, as by `for`."""


@dataclass(frozen=True, slots=True)
class Defined:
    """A binding of a name to a function or class."""

    node: Function | ast.ClassDef
    scope: Scope


@dataclass(frozen=True, slots=True)
class Imported:
    """A binding of a name by an import: to a module, or to a name in it."""

    module: str
    name: str = ""
    """The name of something in the module; empty for the module itself."""


@dataclass(frozen=True, slots=True)
class Parameter:
    """A binding of a name to a parameter of a function."""

    function: Function
    argument: ast.arg
    scope: Scope
    """The scope of the function."""


Binding: TypeAlias = Bound | Defined | Imported | Parameter


@dataclass(eq=False, slots=True)
class Scope:
    """The scope of a module, class or function: the names that it binds, and the scopes inside it."""

    module: Module
    node: ast.Module | Function | ast.ClassDef
    outer: Scope | None
    names: dict[str, list[Binding]] = field(default_factory=dict)
    stars: list[str] = field(default_factory=list)
    """Modules from which it imports all names."""
    attributes: dict[str, list[Binding]] = field(default_factory=dict)
    """For a class: the attributes of `self` that its methods set."""
    body: list[ast.AST] = field(default_factory=list)
    """Every node inside it, without those of inner functions and classes."""
    inner: dict[ast.AST, Scope] = field(default_factory=dict)
    """By function or class."""

    @property
    def owner(self) -> Scope | None:
        """The class of which this scope is the body or a method; None for any other scope."""
        if isinstance(self.node, ast.ClassDef):
            return self
        return self.outer.owner if self.outer is not None else None

    def find_bindings(self, name: str) -> list[Binding]:
        """Return the bindings of a name, as this scope sees it; empty if the program does not bind the name."""
        scope: Scope | None = self
        while scope is not None:
            # Methods do not see the names in the body of their class, so that scope is skipped.
            if name in scope.names and (scope is self or not isinstance(scope.node, ast.ClassDef)):
                return scope.names[name]
            scope = scope.outer
        return []

    def list_items(self, node: ast.expr) -> Iterator[ast.expr]:
        """Yield an expression and, if it is the variable of a loop, also the attributes that the loop goes over.

        For `for motor in (tank.left_motor, tank.right_motor)`, these are the two attributes. For a loop over
        `tank.motors.values()`, `tank` is yielded.
        """
        yield node
        for binding in self.names.get(node.id, ()) if isinstance(node, ast.Name) else ():
            match binding:
                case Bound(node=ast.Tuple(elts=items) | ast.List(elts=items), is_item=True):
                    yield from (item for item in items if isinstance(item, ast.Attribute))
                case Bound(node=ast.Call(func=ast.Attribute(attr="values") as func), is_item=True):
                    if isinstance(func.value, ast.Attribute) and func.value.attr == "motors":
                        yield func.value.value

    def prints(self, node: ast.AST) -> bool:
        """Return whether a node is in an argument of `print` or in an f-string of the scope."""
        return any(
            node is inner
            for shown in self.body
            if isinstance(shown, ast.JoinedStr)
            or (isinstance(shown, ast.Call) and ast.unparse(shown.func) == "print")
            for inner in ast.walk(shown)
        )

    @property
    def top(self) -> Scope:
        """The scope of the module that contains this scope."""
        return self if self.outer is None else self.outer.top


def build_scope(module: Module) -> Scope:
    """Return the scope of a module, with the scopes in it."""
    top = Scope(module, module.tree, None)
    _fill(top, module.tree.body)
    return top


def _fill(scope: Scope, body: list[ast.stmt]) -> None:
    declared: set[str] = set()
    for statement in body:
        for node in _walk(statement):
            scope.body.append(node)
            if isinstance(node, ast.Global):
                declared.update(node.names)
            _bind(scope, node)
            if isinstance(node, UNITS):
                scope.inner[node] = inner = Scope(scope.module, node, scope)
                if not isinstance(node, ast.ClassDef):
                    _bind_parameters(inner, node)
                _fill(inner, node.body)
    if isinstance(scope.node, FUNCTIONS):
        for name in declared & scope.names.keys():
            scope.top.names.setdefault(name, []).extend(scope.names.pop(name))


def _walk(node: ast.AST) -> Iterator[ast.AST]:
    """Yield a node and the nodes inside it in the order of the text, without the bodies of functions and classes."""
    yield node
    if isinstance(node, FUNCTIONS):
        arguments = node.args
        defaults = [
            default
            for default in (*arguments.defaults, *arguments.kw_defaults)
            if default is not None
        ]
        children: list[ast.AST] = [*node.decorator_list, *defaults]
    elif isinstance(node, ast.ClassDef):
        children = [*node.decorator_list, *node.bases, *node.keywords]
    else:
        children = list(ast.iter_child_nodes(node))
    for child in children:
        yield from _walk(child)


def _bind_parameters(scope: Scope, function: Function) -> None:
    arguments = function.args
    for argument in (*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs):
        scope.names.setdefault(argument.arg, []).append(Parameter(function, argument, scope))
    for rest in filter(None, (arguments.vararg, arguments.kwarg)):
        scope.names.setdefault(rest.arg, []).append(Parameter(function, rest, scope))


def _bind(scope: Scope, node: ast.AST) -> None:
    match node:
        case ast.Import(names=names):
            for alias in names:
                bound = alias.asname or alias.name.split(".")[0]
                _add(scope, bound, Imported(alias.name if alias.asname else bound))
        case ast.ImportFrom(module=module, level=level, names=names):
            source = scope.module.absolute(module, level)
            for alias in names:
                if alias.name == "*":
                    scope.stars.append(source)
                else:
                    _add(scope, alias.asname or alias.name, Imported(source, alias.name))
        case ast.FunctionDef() | ast.AsyncFunctionDef() | ast.ClassDef():
            _add(scope, node.name, Defined(node, scope))
        case ast.Assign(targets=targets, value=value):
            for target in targets:
                _bind_target(scope, target, Bound(value, scope))
        case (
            ast.AnnAssign(target=target, value=ast.expr() as value)
            | ast.NamedExpr(target=target, value=value)
        ):
            _bind_target(scope, target, Bound(value, scope))
        case ast.AugAssign(target=target, value=value):
            _bind_target(scope, target, Bound(value, scope))
        case ast.For(target=target, iter=items) | ast.AsyncFor(target=target, iter=items):
            _bind_target(scope, target, Bound(items, scope, is_item=True))
        case ast.comprehension(target=target, iter=items):
            _bind_target(scope, target, Bound(items, scope, is_item=True))
        case ast.withitem(context_expr=value, optional_vars=ast.expr() as target):
            _bind_target(scope, target, Bound(value, scope))


def _add(scope: Scope, name: str, binding: Binding) -> None:
    scope.names.setdefault(name, []).append(binding)


def _bind_target(scope: Scope, target: ast.expr, bound: Bound) -> None:
    match target:
        case ast.Name(id=name):
            _add(scope, name, bound)
        case ast.Attribute(value=ast.Name(id="self" | "cls"), attr=name) if scope.owner is not None:
            scope.owner.attributes.setdefault(name, []).append(bound)
        case ast.Tuple(elts=parts) | ast.List(elts=parts):
            for index, part in enumerate(parts):
                inside = part.value if isinstance(part, ast.Starred) else part
                _bind_target(
                    scope, inside, Bound(bound.node, scope, (*bound.path, index), bound.is_item)
                )


def list_blocks(scope: Scope) -> Iterator[list[ast.stmt]]:
    """Yield each list of statements in a scope: its body, and the bodies of its loops and branches."""
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
