"""The rules of the house that a machine can check."""

from __future__ import annotations

import ast
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
PACKAGE = ROOT / "tuisim"
SOURCES = sorted(PACKAGE.rglob("*.py"))
TESTS = [path for path in sorted((ROOT / "tests").rglob("*.py")) if "brick_programs" not in path.parts]
CODE = [*SOURCES, *TESTS, *sorted((ROOT / "backgrounds").rglob("*.py"))]
PROSE = [ROOT / "README.md", ROOT / "pyproject.toml", ROOT / ".ci" / "run"]

MAX_FILE_LINES = 600
MAX_BODY_LINES = 50
BROAD = {"Exception", "BaseException"}
REASON = re.compile(r"# (?!noqa|type:|pragma|fmt:)\w")
# Reading these would make the same run come out differently.
WALL_CLOCK = {"time", "datetime", "random", "secrets", "uuid"}
CHILD_MAY_NOT_LOAD = ("numpy", "pandas", "pyarrow", "PIL", "plotext", "textual", "platformdirs", "msgspec")


def name_of(path: Path) -> str:
    return str(path.relative_to(ROOT))


def tree_of(path: Path) -> ast.Module:
    return ast.parse(path.read_text(encoding="utf-8"))


Function = ast.FunctionDef | ast.AsyncFunctionDef


def functions(tree: ast.AST) -> Iterator[Function]:
    return (node for node in ast.walk(tree) if isinstance(node, Function))


def body_lines(function: Function) -> int:
    """Lines of the body, its docstring left out."""
    body = function.body[1:] if ast.get_docstring(function) is not None else function.body
    return (body[-1].end_lineno or 0) - body[0].lineno + 1 if body else 0


@pytest.mark.parametrize("path", CODE, ids=name_of)
def test_file_is_small(path: Path) -> None:
    assert len(path.read_text(encoding="utf-8").splitlines()) <= MAX_FILE_LINES


@pytest.mark.parametrize("path", CODE, ids=name_of)
def test_functions_are_small(path: Path) -> None:
    long = {f.name: body_lines(f) for f in functions(tree_of(path)) if body_lines(f) > MAX_BODY_LINES}
    assert not long


PRINTS = {"echo.py": "the one place", "relay.py": "passes on what a program prints"}
"""Files of the commands that may write to the terminal by themselves."""


@pytest.mark.parametrize("path", [*sorted((PACKAGE / "commands").rglob("*.py"))], ids=name_of)
def test_commands_print_by_echo(path: Path) -> None:
    if path.name in PRINTS:
        return
    tree = tree_of(path)
    prints = [node.lineno for node in ast.walk(tree) if isinstance(node, ast.Name) and node.id == "print"]
    writes = [
        node.lineno
        for node in ast.walk(tree)
        if isinstance(node, ast.Attribute) and node.attr == "write" and ast.unparse(node.value).startswith("sys.")
    ]
    assert not prints + writes


def caught(handler: ast.ExceptHandler) -> set[str]:
    """Names that a handler catches; empty for a bare except."""
    if handler.type is None:
        return set()
    parts = handler.type.elts if isinstance(handler.type, ast.Tuple) else [handler.type]
    return {part.id for part in parts if isinstance(part, ast.Name)} or {"?"}


@pytest.mark.parametrize("path", CODE, ids=name_of)
def test_broad_excepts_say_why(path: Path) -> None:
    lines = path.read_text(encoding="utf-8").splitlines()
    unexplained = [
        handler.lineno
        for handler in ast.walk(tree_of(path))
        if isinstance(handler, ast.ExceptHandler)
        and (not caught(handler) or caught(handler) & BROAD)
        and not any(REASON.search(line) for line in lines[handler.lineno - 2 : handler.lineno])
    ]
    assert not unexplained


@pytest.mark.parametrize("path", sorted((PACKAGE / "core").rglob("*.py")), ids=name_of)
def test_core_has_no_clock_and_no_global_random(path: Path) -> None:
    imported = set()
    for node in ast.walk(tree_of(path)):
        if isinstance(node, ast.Import):
            imported |= {alias.name.split(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            imported.add(node.module.split(".")[0])
    assert not imported & WALL_CLOCK


def public(body: list[ast.stmt], prefix: str = "") -> Iterator[tuple[str, Function | ast.ClassDef]]:
    """Yield public functions, classes and methods."""
    for node in body:
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef) and not node.name.startswith("_"):
            yield prefix + node.name, node
            if isinstance(node, ast.ClassDef):
                yield from public(node.body, f"{node.name}.")


def explained_elsewhere(node: ast.stmt) -> bool:
    """Whether this is a member of a Protocol that repeats another class, or the setter of a property."""
    match node:
        case ast.FunctionDef(body=[ast.Expr(value=ast.Constant(value=value))]) if value is Ellipsis:
            return True
        case ast.FunctionDef(decorator_list=[ast.Attribute(attr="setter")]):
            return True
    return False


@pytest.mark.parametrize("path", SOURCES, ids=name_of)
def test_public_names_have_docstrings(path: Path) -> None:
    tree = tree_of(path)
    bare = [
        name for name, node in public(tree.body) if ast.get_docstring(node) is None and not explained_elsewhere(node)
    ]
    assert ast.get_docstring(tree), "the module itself"
    assert not bare


@pytest.mark.parametrize("path", [*CODE, *PROSE], ids=name_of)
def test_nothing_is_left_open_and_no_machine_is_named(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    words = "|".join(("TO" + "DO", "FIX" + "ME", "XX" + "X", "NotImplemented" + "Error"))
    places = "|".join(f"/{place}/" for place in ("work", "farm", "root", "home"))
    found = [line for line in text.splitlines() if re.search(rf"\b({words})\b|(?<![\w.$])({places})", line)]
    assert not found


@pytest.mark.parametrize("path", SOURCES, ids=name_of)
def test_lines_are_split_as_python_counts_them(path: Path) -> None:
    calls = {node.attr for node in ast.walk(tree_of(path)) if isinstance(node, ast.Attribute)}
    assert "splitlines" not in calls, "source_lines"


@pytest.mark.parametrize("path", TESTS, ids=name_of)
def test_no_test_is_skipped(path: Path) -> None:
    marks = {node.attr for node in ast.walk(tree_of(path)) if isinstance(node, ast.Attribute)}
    assert not marks & {"skip", "xfail"}


def tool(*words: str) -> str:
    """Run a checker over the project and return what it complains about."""
    done = subprocess.run([sys.executable, "-m", *words], cwd=ROOT, capture_output=True, text=True, check=False)
    return "" if done.returncode == 0 else done.stdout + done.stderr


def test_imports_go_one_way() -> None:
    program = "import sys; from importlinter.cli import lint_imports; sys.exit(lint_imports(no_cache=True))"
    done = subprocess.run([sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_ruff_finds_nothing() -> None:
    assert tool("ruff", "check", "--no-cache", ".") == ""


@pytest.mark.parametrize(
    "words",
    # Tests and drawings may import what only the tests need, and need not use everything.
    [["tuisim"], ["tests", "backgrounds", "--ignore", "DEP002,DEP004"]],
    ids=["package", "tests and drawings"],
)
def test_imported_packages_are_declared(words: list[str]) -> None:
    assert tool("deptry", "--no-ansi", *words) == ""


@pytest.mark.slow
def test_types_are_strict() -> None:
    assert tool("mypy") == ""


@pytest.mark.parametrize("module", ["tuisim.runtime", "tuisim.shim"])
def test_child_starts_light(module: str) -> None:
    program = (
        f"import importlib, pkgutil, sys; package = importlib.import_module({module!r})\n"
        f"[importlib.import_module(m.name) for m in pkgutil.walk_packages(package.__path__, {module + '.'!r})"
        " if not m.name.endswith('__main__')]\n"
        f"print(*(set({CHILD_MAY_NOT_LOAD!r}) & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.split() == []


def test_help_starts_light() -> None:
    program = "import sys; from tuisim.cli import run_command\ntry: run_command(['--help'])\nexcept SystemExit: pass\n"
    program += "print('LOADED', *sys.modules)"
    done = subprocess.run([sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True, check=True)
    loaded = done.stdout.split("LOADED")[1].split()
    assert not set(CHILD_MAY_NOT_LOAD) & set(loaded)
