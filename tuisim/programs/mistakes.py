"""What is wrong with a program: why it cannot run, and lines that do nothing although they look as if they did more."""

from __future__ import annotations

import ast
import io
import tokenize
import warnings
from collections.abc import Iterator, Sequence
from itertools import pairwise


def find_fault(text: str) -> tuple[str, int] | None:
    """Return why a program does not compile, and the line's number, 0 if unknown; None if the program compiles."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            data = text.encode("utf-8", "surrogateescape")
            # The text is compiled as bytes, since a line in it may name an encoding that does not exist.
            encoding, _ = tokenize.detect_encoding(io.BytesIO(data).readline)
            compile(text.encode(encoding, "surrogateescape"), "program", "exec", dont_inherit=True)
    except SyntaxError as error:
        return error.msg, error.lineno or 0
    except (LookupError, ValueError, RecursionError, MemoryError) as error:
        return str(error) or "too deeply nested", 0
    return None


def list_slips(tree: ast.Module) -> Iterator[tuple[int, str]]:
    """Yield for each kind of slip, such as a stop without `()`, the first line with it and a description."""
    for find_slip in (
        _find_uncalled_method,
        _find_equal_branches,
        _find_idle_comparison,
        _find_missing_return,
        _find_short_wait,
    ):
        if slip := find_slip(tree):
            yield slip


def find_idle_definition(tree: ast.Module) -> tuple[int, str] | None:
    """Return the last function or class of a program that only has definitions, and why it does nothing.

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


def _find_uncalled_method(tree: ast.Module) -> tuple[int, str] | None:
    """Return the first line that names a method without calling it, and a description; None if there is none."""
    for node in ast.walk(tree):
        match node:
            case ast.Expr(value=ast.Attribute() as name):
                words = ast.unparse(name)
                return node.lineno, f"{words} without () does nothing: {words}() calls it"
    return None


def _find_equal_branches(tree: ast.Module) -> tuple[int, str] | None:
    """Return the first line with an `if` whose opposite case does the same, and a description; None if there is none.

    The opposite case is its `else`, or the next `if` with the opposite comparison.
    """
    pairs: list[tuple[int, str]] = []
    for node in ast.walk(tree):
        if isinstance(node, ast.If) and node.orelse and _dump(node.body) == _dump(node.orelse):
            pairs.append((node.lineno, "if and else do the same"))
        block = getattr(node, "body", [])
        for first, second in pairwise(block if isinstance(block, list) else []):
            if _is_opposite(first, second):
                text = f"line {second.lineno} asks the opposite, and does the same"
                pairs.append((first.lineno, text))
    return min(pairs, default=None)


def _is_opposite(first: ast.stmt, second: ast.stmt) -> bool:
    """Return whether two `if` statements have the same body, one below a limit and the other above it."""
    match first, second:
        case (
            ast.If(test=ast.Compare(ops=[way]) as test, orelse=[]),
            ast.If(test=ast.Compare(ops=[other]) as opposite, orelse=[]),
        ):
            is_below = [isinstance(each, ast.Lt | ast.LtE) for each in (way, other)]
            is_above = [isinstance(each, ast.Gt | ast.GtE) for each in (way, other)]
            parts = [_dump([each.left, *each.comparators]) for each in (test, opposite)]
            are_opposite = (is_below[0] and is_above[1]) or (is_above[0] and is_below[1])
            return are_opposite and parts[0] == parts[1] and _dump(first.body) == _dump(second.body)
    return False


def _dump(nodes: Sequence[ast.AST]) -> list[str]:
    return [ast.dump(each) for each in nodes]


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
    empty = {
        node.name: node.lineno
        for node in tree.body
        if isinstance(node, ast.FunctionDef)
        and not node.decorator_list
        and not any(_gives_value(part) for part in ast.walk(node))
        and not isinstance(node.body[-1], ast.Raise)
        # A comparison in the last line is a slip of its own.
        and not (
            isinstance(node.body[-1], ast.Expr) and isinstance(node.body[-1].value, ast.Compare)
        )
    }
    for node in ast.walk(tree):
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
    for node in ast.walk(tree):
        block = getattr(node, "body", [])
        calls = [
            getattr(step, "value", None) for step in (block if isinstance(block, list) else [])
        ]
        calls = [call for call in calls if not _is_print(call)]
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


def _is_print(call: ast.expr | None) -> bool:
    match call:
        case ast.Call(func=ast.Name(id="print") | ast.Attribute(attr="print")):
            return True
    return False
