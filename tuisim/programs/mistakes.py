"""What is wrong with a program: why it cannot run, and lines that do nothing although they look as if they did more."""

from __future__ import annotations

import ast
import warnings
from collections.abc import Iterable, Iterator, Sequence

from tuisim.base.source import PYBRICKS, find_encoding
from tuisim.programs.comparisons import is_set
from tuisim.programs.moves import ANY_MOVE, STOPS
from tuisim.programs.pure_expressions import READ_METHODS
from tuisim.programs.questions import COLOR_WORDS
from tuisim.programs.statements import list_blocks, name_call
from tuisim.programs.wrong_calls import explain_call, find_makers


def find_fault(text: str) -> tuple[str, int] | None:
    """Return why a program does not compile, and the line's number, 0 if unknown; None if the program compiles."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            data = text.encode("utf-8", "surrogateescape")
            # The text is compiled as bytes, since a line in it may name an encoding that does not exist.
            encoding = find_encoding(data)
            compile(text.encode(encoding, "surrogateescape"), "program", "exec", dont_inherit=True)
    except SyntaxError as error:
        return error.msg, error.lineno or 0
    except (LookupError, ValueError, RecursionError, MemoryError) as error:
        return str(error) or "too deeply nested", 0
    return None


def list_slips(tree: ast.Module) -> Iterator[tuple[int, str]]:
    """Yield lines that probably contain a mistake, such as a stop without `()`, each with a description.

    Of each kind of mistake, only the first line is yielded.
    """
    for find_slip in (
        _find_uncalled_method,
        _find_uncalled_function,
        _find_equal_branches,
        _find_idle_comparison,
        _find_missing_return,
        _find_short_wait,
        _find_colour_text,
    ):
        if slip := find_slip(tree):
            yield slip


def find_idle_definition(tree: ast.Module) -> tuple[int, str] | None:
    """If a program only has definitions, return the line of the last function or class, and why it does nothing.

    The result is None for any other program.
    """
    last: ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef | None = None
    for node in tree.body:
        match node:
            case ast.FunctionDef() | ast.AsyncFunctionDef() | ast.ClassDef():
                last = node
            case ast.Import() | ast.ImportFrom() | ast.Expr(value=ast.Constant()):
                pass
            case ast.Assign() | ast.AnnAssign() if _only_makes(node):
                pass
            case _:
                return None
    if last is None:
        return None
    return last.lineno, f"the program only defines, and calls nothing: {last.name}() is missing"


def _only_makes(node: ast.AST) -> bool:
    """Return whether all calls in a node have the name of a class, so that they only create objects."""
    calls = (part.func for part in ast.walk(node) if isinstance(part, ast.Call))
    return all(ast.unparse(name).rpartition(".")[2][:1].isupper() for name in calls)


_SHOWS = ("print", "str", "int", "float", "abs", "round")


def _find_uncalled_method(tree: ast.Module) -> tuple[int, str] | None:
    """Return the first line that names a method without calling it, and a description; None if there is none.

    A name that stands alone on a line may also be a value, such as `color` in `ev3dev2`. The description then says what
    to write in both cases.
    """
    nodes = [*ast.walk(tree)]
    for node in nodes:
        match node:
            case ast.Expr(value=ast.Attribute(attr=attr) as name) if not attr.startswith("__"):
                words = ast.unparse(name)
                if attr in (*ANY_MOVE, *STOPS):
                    return node.lineno, f"{words} without () does nothing: {words}() calls it"
                return (
                    node.lineno,
                    f"{words} alone does nothing: {words}() calls it if it is a method, "
                    f"print({words}) shows it if it is a value",
                )
    devices = {*_list_devices(nodes)}
    methods = [
        (value.lineno, _describe_uncalled(value))
        for _, value in _list_used(nodes)
        if isinstance(value, ast.Attribute)
        and value.attr in READ_METHODS
        and not devices.isdisjoint(ast.unparse(value.value).split("."))
    ]
    return min(methods, default=None)


def _find_uncalled_function(tree: ast.Module) -> tuple[int, str] | None:
    """Return the first line with the name of one of the program's functions, but without `()`, and a description.

    Only a name that stands alone on a line or is a whole condition counts. The result is None if there is no such line.
    """
    nodes = [*ast.walk(tree)]
    others = {node.id for node in nodes if isinstance(node, ast.Name) and is_set(node)}
    others |= {node.arg for node in nodes if isinstance(node, ast.arg)}
    others |= {node.asname or node.name for node in nodes if isinstance(node, ast.alias)}
    functions = {node.name for node in nodes if isinstance(node, ast.FunctionDef)} - others
    for node in nodes:
        match node:
            case ast.Expr(value=ast.Name(id=name)) if name in functions:
                return node.lineno, f"{name} without () does nothing: {name}() calls it"
            case (
                ast.If(test=ast.Name(id=name))
                | ast.While(test=ast.Name(id=name))
                | ast.UnaryOp(op=ast.Not(), operand=ast.Name(id=name))
            ) if name in functions:
                return node.lineno, f"{name} without () is always true: {name}() asks"
    return None


def _list_devices(nodes: Sequence[ast.AST]) -> Iterator[str]:
    """Yield the names of the variables and attributes for devices, such as `motor` in `motor = Motor(Port.A)`.

    Only classes that the program imports from Pybricks are considered.
    """
    classes = [
        alias.asname or alias.name
        for node in nodes
        if isinstance(node, ast.ImportFrom) and (node.module or "").partition(".")[0] == PYBRICKS
        for alias in node.names
    ]
    for node in nodes:
        match node:
            case ast.Assign(targets=targets, value=ast.Call(func=ast.Name(id=name))) if (
                name in classes
            ):
                yield from (_name_function(target) for target in targets)


def _describe_uncalled(name: ast.expr) -> str:
    words = ast.unparse(name)
    return f"{words} without () is not a value: {words}() gives one"


def _list_used(nodes: Sequence[ast.AST]) -> Iterator[tuple[int, ast.expr]]:
    """Yield the expressions whose values the program compares, tests, computes with or shows, each with its line.

    If a variable only stands for an attribute, as after `press = button.pressed`, the attribute is yielded.
    """
    stored = [node.id for node in nodes if isinstance(node, ast.Name) and is_set(node)]
    aliases: dict[str, ast.expr] = {}
    uses: list[ast.expr] = []
    for node in nodes:
        match node:
            case ast.Assign(targets=[ast.Name(id=name)], value=ast.Attribute() as value) if (
                stored.count(name) == 1
            ):
                aliases[name] = value
            case ast.Compare(left=left, comparators=others):
                uses += [left, *others]
            case ast.BinOp(left=left, right=right):
                uses += [left, right]
            case ast.BoolOp(values=values):
                uses += values
            case ast.If(test=value) | ast.While(test=value) | ast.IfExp(test=value):
                uses.append(value)
            case ast.UnaryOp(operand=value) | ast.FormattedValue(value=value):
                uses.append(value)
            case ast.Call(func=ast.Name(id=name), args=args) if name in _SHOWS:
                uses += args
    for use in uses:
        yield use.lineno, aliases.get(use.id, use) if isinstance(use, ast.Name) else use


def explain_error(tree: ast.Module, error: str, line: int) -> str:
    """Return why a line raised an error: it uses a method without `()`, a function without `return`, or wrong values.

    The result is empty for other errors.

    Args:
        tree: The program.
        error: The name and the text of the error.
        line: The line that raised it.
    """
    nodes = [*ast.walk(tree)]
    if "'method'" in error or "'function'" in error:
        functions = [node.name for node in nodes if isinstance(node, ast.FunctionDef)]
        used = [value for used_line, value in _list_used(nodes) if used_line == line]
        names = [
            value
            for value in used
            if isinstance(value, ast.Attribute) or getattr(value, "id", "") in functions
        ]
        return _describe_uncalled(names[0]) if len(names) == 1 else ""
    if "NoneType" not in error:
        return explain_call(tree, error, line)
    empty = _map_empty_functions(nodes)
    results: dict[str, str] = {}
    for node in nodes:
        match node:
            case ast.Assign(targets=[target], value=ast.Call(func=func)):
                results[ast.unparse(target)] = _name_function(func)
            case ast.Call(func=func):
                results[ast.unparse(node)] = _name_function(func)
    for node in nodes:
        if isinstance(node, ast.expr) and node.lineno == line:
            words = ast.unparse(node)
            if (name := results.get(words, "")) in empty:
                return f"{words} is None: {name}(), line {empty[name]}, has no return"
    return ""


def _name_function(func: ast.expr) -> str:
    return ast.unparse(func).rpartition(".")[2]


def _map_empty_functions(nodes: Iterable[ast.AST]) -> dict[str, int]:
    """Return the first lines of functions that never return a value, by name; without names that occur twice."""
    functions = [node for node in nodes if isinstance(node, ast.FunctionDef)]
    names = [function.name for function in functions]
    return {
        node.name: node.lineno
        for node in functions
        if names.count(node.name) == 1
        and not node.decorator_list
        and not any(_gives_value(part) for part in ast.walk(node))
        and not isinstance(node.body[-1], ast.Raise)
    }


def _find_equal_branches(tree: ast.Module) -> tuple[int, str] | None:
    """Return the first line with an `if` whose `else` does the same, and a description; None if there is none."""
    lines = [
        node.lineno
        for node in ast.walk(tree)
        if isinstance(node, ast.If) and node.orelse and _is_equal(node.body, node.orelse)
    ]
    return (min(lines), "if and else do the same") if lines else None


def _is_equal(first: object, second: object) -> bool:
    """Return whether two syntax nodes, or two lists of nodes, have the same text.

    This does not recurse, because a chain of `elif` may be too deep for that.
    """
    pairs = [(first, second)]
    while pairs:
        left, right = pairs.pop()
        match left, right:
            case list(), list() if len(left) == len(right):
                pairs += zip(left, right, strict=True)
            case ast.AST(), ast.AST() if type(left) is type(right):
                pairs += [(getattr(left, name), getattr(right, name)) for name in left._fields]
            case _ if left != right:
                return False
    return True


def _find_idle_comparison(tree: ast.Module) -> tuple[int, str] | None:
    """Return the first line with a comparison whose result is not used, and a description; None if there is none.

    A comparison in a `try` is ignored: the program may use whether it raises an error.
    """
    nodes = [*ast.walk(tree)]
    tried = {part for node in nodes if isinstance(node, ast.Try) for part in ast.walk(node)}
    functions = {
        node.body[-1]: node.name
        for node in nodes
        if isinstance(node, ast.FunctionDef)
        and not any(isinstance(part, ast.Return | ast.Yield) for part in ast.walk(node))
    }
    idle = [
        (node.lineno, _describe_idle(node.value, functions.get(node, "")))
        for node in nodes
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Compare) and node not in tried
    ]
    return min(idle, default=None)


def _describe_idle(test: ast.Compare, function: str) -> str:
    """Return why a comparison whose result is not used does nothing.

    Args:
        test: The comparison.
        function: The name of the function whose last line it is; empty for none.
    """
    words = ast.unparse(test)
    match test:
        case ast.Compare() if function:
            return f"{function}() returns nothing: return is missing before {words}"
        case ast.Compare(left=ast.Name(id=name), ops=[ast.Eq()], comparators=[value]):
            return f"{words} only compares: {name} = {ast.unparse(value)} sets it"
        case _:
            return f"{words} alone does nothing: the answer is not used"


def _find_missing_return(tree: ast.Module) -> tuple[int, str] | None:
    """Return the first condition that calls a function which returns nothing, and a description.

    The result is None if there is none.
    """
    # A comparison in the last line is a slip of its own.
    nodes = [node for node in ast.walk(tree) if not _ends_idle(node)]
    empty = _map_empty_functions(nodes)
    for node in nodes:
        match node:
            case ast.If(test=test) | ast.While(test=test):
                match test:
                    case ast.UnaryOp(op=ast.Not(), operand=asked):
                        answer = "always"
                    case asked:
                        answer = "never"
                match asked:
                    case ast.Call(func=ast.Name(id=name)) if name in empty:
                        text = f"{name}() returns nothing, so this is {answer} true"
                        return (
                            node.lineno,
                            f"{text}: return is missing in line {empty[name]} and on",
                        )
    return None


def _ends_idle(node: ast.AST) -> bool:
    match node:
        case ast.FunctionDef(body=[*_, ast.Expr(value=ast.Compare())]):
            return True
    return False


def _gives_value(node: ast.AST) -> bool:
    return isinstance(node, ast.Yield | ast.YieldFrom) or (
        isinstance(node, ast.Return) and node.value is not None
    )


_MAX_SLIP_MS = 20
"""In this time a motor hardly begins to turn."""
_STARTS = ("drive", "run", "dc")
_STOPS = ("stop", "brake", "hold")


def _find_short_wait(tree: ast.Module) -> tuple[int, str] | None:
    """Return the first `wait` of so few ms that seconds were probably meant, and a description; None if there is none.

    Only a `wait` between the start and the stop of a motor is considered.
    """
    for block in list_blocks(tree):
        calls = [getattr(step, "value", None) for step in block if name_call(step) != "print"]
        for three in zip(calls, calls[1:], calls[2:], strict=False):
            match three:
                case (
                    ast.Call(func=ast.Attribute(attr=start)),
                    ast.Call(
                        func=ast.Name(id="wait"), args=[ast.Constant(int() | float() as ms)]
                    ) as wait,
                    ast.Call(func=ast.Attribute(attr=stop)),
                ) if start in _STARTS and stop in _STOPS and ms <= _MAX_SLIP_MS:
                    text = f"wait({ms}) waits only {ms} ms: wait({ms * 1000:g}) waits {ms} s"
                    return wait.lineno, text
    return None


def _find_colour_text(tree: ast.Module) -> tuple[int, str] | None:
    """Return the first line that compares a colour with a text such as `"red"`, and a description.

    A sensor's `color` is never a text. A `while` with such a comparison is left out, unless the text is in capitals,
    because the reasons why the run went wrong then say what it waited for. The result is None if there is no such line.
    """
    nodes = [*ast.walk(tree)]
    waits = [node.test for node in nodes if isinstance(node, ast.While)]
    eyes = find_makers(tree, ("ColorSensor",))
    lines: list[tuple[int, str]] = []
    for node in nodes:
        match node:
            case ast.Compare(
                left=ast.Attribute(value=eye, attr="color")
                | ast.Call(func=ast.Attribute(value=eye, attr="color"), args=[]) as color,
                ops=[ast.Eq() | ast.NotEq()],
                comparators=[ast.Constant(value=str() as text)],
            ) if (
                ast.unparse(eye) in eyes
                and text.lower() in COLOR_WORDS.values()
                and (node not in waits or text.isupper())
            ):
                words = "color is a number: color_name is the word"
                if isinstance(color, ast.Call):
                    words = f"a text equals no colour: write Color.{text.upper()}"
                lines.append((node.lineno, words))
    return min(lines, default=None)
