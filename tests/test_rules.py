"""The rules of the house that a machine can check."""

from __future__ import annotations

import ast
import gc
import re
import subprocess
import sys
import tomllib
from collections.abc import Callable, Iterable, Iterator
from functools import cache
from importlib import import_module
from pathlib import Path

import pytest
import textual

from tests.rooms import OPEN, door_of, entered, list_rooms, write_contracts
from tests.sources import ROOT, Function, Source, python_files, source
from tests.words import TABLE as WORDS
from tests.words import count_faults
from tuisim import terminal

MAX_FILE_TOKENS = 3_500
MAX_FUNCTION_TOKENS = 350
OVERSIZED: dict[str, dict[str, int]] = tomllib.loads(
    (ROOT / "tests" / "oversized.toml").read_text(encoding="utf-8")
)
"""Files and functions that were above a limit when it was set. A line leaves when its subject fits."""
BROAD = {"Exception", "BaseException"}
REASON = re.compile(r"# (?!noqa|type:|pragma|fmt:)\w")
# Reading these would make the same run come out differently.
WALL_CLOCK = {"time", "datetime", "random", "secrets", "uuid"}
HELP_MAY_NOT_LOAD = (
    "numpy",
    "pandas",
    "pyarrow",
    "PIL",
    "plotext",
    "textual",
    "platformdirs",
    "msgspec",
)
CHILD_MAY_NOT_LOAD = (*HELP_MAY_NOT_LOAD, "argparse", "click")
PRINTS = {"echo.py": "the one place", "relay.py": "passes on what a program prints"}
"""Files of the commands that may write to the terminal by themselves."""
TEXTUAL_CALLS = re.compile(r"compose|compose_content|render|(on|action)_\w+")
VALUE_METHODS = re.compile(
    r"allowed|metavar|choices|check|parse_data|parse_text|format_text|name_key"
)
"""What `Value` and `Spec` explain for all of their subclasses."""
UNFINISHED = "|".join(("TO" + "DO", "FIX" + "ME", "XX" + "X", "NotImplemented" + "Error"))
PLACES = "|".join(f"/{place}/" for place in ("work", "farm", "root", "home"))
LEFT_OPEN = re.compile(rf"\b({UNFINISHED})\b|(?<![\w.$])(?!/home/robot)({PLACES})")
"""The home folder of the brick is no place on a machine."""

OF_THE_BRICK = "# as on the brick"
"""Marks an error that a library of the brick raises, too."""

LONG_TOKENS = 1_300
"""A module with more has a test of its own."""
TESTED_BESIDE = {
    "app/analyser/actions/keys.py": "app/analyser/test_screen.py",
    "app/panels/instrumentation_lines.py": "app/panels/test_instrumentation.py",
    "app/setup/fields.py": "app/setup/test_next_run.py",
    "programs/robot/scopes.py": "programs/robot/test_evaluation.py",
    "engine/core/commands/table.py": "engine/shim/pybricks/test_reference.py",
    "engine/core/servo/drive_base.py": "engine/shim/pybricks/test_reference.py",
    "tasks/goals/evidence.py": "tasks/goals/test_judge_conditions.py",
    "tasks/goals/output.py": "tasks/goals/test_judge_conditions.py",
    "tasks/goals/places.py": "tasks/goals/test_judge_conditions.py",
    "tasks/goals/spec.py": "tasks/goals/test_files.py",
    "tasks/lessons/spec.py": "tasks/lessons/test_files.py",
    "engine/runtime/debugger/conditions.py": "engine/runtime/debugger/test_debugger.py",
    "engine/shim/pybricks/motor.py": "engine/shim/pybricks/test_reference.py",
    "engine/shim/pybricks/robotics.py": "engine/shim/pybricks/test_reference.py",
}
"""Long modules whose only caller is tested, with every case of theirs: by module, the test."""
OF_NO_MODULE = {
    "settings/golden/test_golden.py": "what settings and programs gave before",
    "engine/shim/pybricks/test_reference.py": "what the firmware's own code did",
    "engine/shim/pybricks/test_api.py": "the whole library, as its firmware has it",
    "guide/test_claims.py": "what the pages claim",
    "guide/test_documents.py": "what the pages run and name",
    "guide/test_ev3dev2_and_pybricks.py": "the table with the calls of both libraries",
    "guide/test_pybricks_hubs.py": "the tables of what each hub has and refuses",
    "guide/test_the_real_robot_sensors.py": "the table of what sensors do on bricks and here",
    "guide/test_readme_film.py": "README's film",
    "guide/test_the_real_robot.py": "the tables of what was measured on bricks",
    "test_brick_programs.py": "programs of others, as a whole",
    "test_hosts.py": "an enemy in every host",
    "test_licences.py": "the packages that an install brings",
    "test_nested_json.py": "one kind of damage in each file that is read",
    "test_examples.py": "the examples",
    "test_pybricks_programs.py": "programs of others, as a whole",
    "test_readme.py": "README and guide beside all tables",
    "test_real_programs.py": "programs of others, as a whole",
    "test_rules.py": "all files",
    "test_wheel.py": "an installed copy",
}
"""Tests that stand among those of modules, with what they test."""

OTHERS_OWN = ("os", "sys", "super()")
"""What has such names and is not Textual's."""

TOP_LEVEL = {
    ".ci",
    ".git-blame-ignore-revs",
    ".gitignore",
    "CHANGELOG.md",
    "LICENSE",
    "README.md",
    "backgrounds",
    "programs",
    "pyproject.toml",
    "tests",
    "tuisim",
}
"""What git may track there: all else is somebody's own."""

WITH_COLORS = frozenset({"css_colors.py", "design.py", "palette.py", "themes.py"})
"""The palette, and tables of colours of others."""

PACKAGE = python_files("tuisim")
TESTS = python_files("tests")
CODE = [*PACKAGE, *TESTS, *python_files("backgrounds")]
MIRRORED = [
    path
    for path in TESTS
    if path.name.startswith("test_")
    and path.relative_to(ROOT / "tests").parts[0] not in ("backgrounds", "bench", "proof")
]
"""Tests of the package, at the paths of its modules."""
PROSE = [ROOT / "README.md", ROOT / "pyproject.toml", ROOT / ".ci" / "run"]


@pytest.fixture(scope="module", autouse=True)
def _trees_are_no_garbage() -> Iterator[None]:
    """Look for no garbage among a million nodes, and leave none of them to the tests that follow."""
    gc.disable()
    yield
    source.cache_clear()
    gc.enable()


def _above(name: str, tokens: int, limit: int, kind: str) -> list[object]:
    """Return what is wrong with a size: nothing if it is in `oversized.toml` and has not grown."""
    accepted = OVERSIZED[kind].get(name)
    if accepted is None:
        return [f"{name}: {tokens} tokens"] if tokens > limit else []
    if tokens <= limit:
        return [f"{name} fits: strike its line in oversized.toml"]
    return [f"{name}: {tokens} tokens, {accepted} before"] if tokens > accepted else []


def large_files(source: Source) -> Iterable[object]:
    name = source.path.relative_to(ROOT).as_posix()
    if name not in OVERSIZED["files"] and source.most_tokens[-1] <= MAX_FILE_TOKENS:
        return []
    return _above(name, len(source.token_lines), MAX_FILE_TOKENS, "files")


def functions_in(nodes: Iterable[ast.stmt], prefix: str) -> Iterator[tuple[str, Function]]:
    """Yield all functions with the names of what they are in."""
    for node in nodes:
        if isinstance(node, Function | ast.ClassDef):
            if isinstance(node, Function):
                yield prefix + node.name, node
            yield from functions_in(node.body, f"{prefix}{node.name}.")


def large_functions(source: Source) -> Iterable[object]:
    module = source.path.relative_to(ROOT).as_posix()
    sizes: dict[str, int] = {}
    for name, node in functions_in(source.tree.body, f"{module}:"):
        last = node.end_lineno or 0
        size = source.most_tokens[last] - source.most_tokens[node.lineno - 1]
        if name in OVERSIZED["functions"] or size > MAX_FUNCTION_TOKENS:
            size = sum(node.lineno <= line <= last for line in source.token_lines)
        sizes[name] = max(size, sizes.get(name, 0))
    return [
        fault
        for name, size in sizes.items()
        for fault in _above(name, size, MAX_FUNCTION_TOKENS, "functions")
    ]


def test_each_file_in_the_list_of_oversized_exists() -> None:
    names = {path.relative_to(ROOT).as_posix() for path in CODE}
    assert {
        name for kind in OVERSIZED.values() for name in kind if name.split(":")[0] not in names
    } == set()


def prints(source: Source) -> Iterable[object]:
    if source.path.name in PRINTS:
        return []
    calls = [
        node.lineno for node in source.nodes if isinstance(node, ast.Name) and node.id == "print"
    ]
    return calls + [
        node.lineno
        for node in source.attributes
        if node.attr == "write" and ast.unparse(node.value).startswith("sys.")
    ]


def caught(handler: ast.ExceptHandler) -> set[str]:
    """Names that a handler catches; empty for a bare except."""
    if handler.type is None:
        return set()
    parts = handler.type.elts if isinstance(handler.type, ast.Tuple) else [handler.type]
    return {part.id for part in parts if isinstance(part, ast.Name)} or {"?"}


def unexplained_broad_excepts(source: Source) -> Iterable[object]:
    return [
        handler.lineno
        for handler in source.nodes
        if isinstance(handler, ast.ExceptHandler)
        and (not caught(handler) or caught(handler) & BROAD)
        and not any(
            REASON.search(line) for line in source.lines[handler.lineno - 2 : handler.lineno + 1]
        )
    ]


def clocks_and_global_random(source: Source) -> Iterable[object]:
    imported = set()
    for node in source.nodes:
        if isinstance(node, ast.Import):
            imported |= {alias.name.split(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            imported.add(node.module.split(".")[0])
    return imported & WALL_CLOCK


def public(body: list[ast.stmt], prefix: str = "") -> Iterator[tuple[str, Function | ast.ClassDef]]:
    """Yield public functions, classes and methods."""
    for node in body:
        if isinstance(
            node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef
        ) and not node.name.startswith("_"):
            yield prefix + node.name, node
            if isinstance(node, ast.ClassDef):
                yield from public(node.body, f"{node.name}.")


def explained_elsewhere(node: ast.stmt) -> bool:
    """Whether this is a member of a Protocol that repeats another class, the setter of a property, or a method that
    Textual, a dialog, `Value` or `Spec` calls by its name, which says when."""
    match node:
        case (
            ast.FunctionDef(name=name, args=ast.arguments(args=[ast.arg(arg="self"), *_]))
            | ast.AsyncFunctionDef(name=name, args=ast.arguments(args=[ast.arg(arg="self"), *_]))
        ) if TEXTUAL_CALLS.fullmatch(name) or VALUE_METHODS.fullmatch(name):
            return True
        case ast.FunctionDef(body=[ast.Expr(value=ast.Constant(value=value))]) if value is Ellipsis:
            return True
        case ast.FunctionDef(decorator_list=[ast.Attribute(attr="setter")]):
            return True
    return False


def bare_names(source: Source) -> Iterable[object]:
    module = [] if ast.get_docstring(source.tree) else ["the module itself"]
    return module + [
        name
        for name, node in public(source.tree.body)
        if ast.get_docstring(node) is None and not explained_elsewhere(node)
    ]


def open_ends_and_machines(source: Source) -> Iterable[object]:
    return [
        line for line in source.lines if LEFT_OPEN.search(line) and not line.endswith(OF_THE_BRICK)
    ]


def other_line_splits(source: Source) -> Iterable[object]:
    """Lines are split as Python counts them: by `source_lines`."""
    return [node.lineno for node in source.attributes if node.attr == "splitlines"]


def skipped_tests(source: Source) -> Iterable[object]:
    return [node.lineno for node in source.attributes if node.attr in ("skip", "xfail")]


def subject(test: Path) -> str:
    """Return the module or package at the path of a test that it is named after: `test_NAME.py` or
    `test_NAME_ASPECT.py`; empty if there is none."""
    folder = ROOT / "tuisim" / test.parent.relative_to(ROOT / "tests")
    words = test.stem.removeprefix("test_").split("_")
    for count in range(len(words), 0, -1):
        path = folder / "_".join(words[:count])
        for file in (path.with_suffix(".py"), path / "__init__.py"):
            if file.is_file():
                return file.relative_to(ROOT / "tuisim").as_posix()
    return ""


@cache
def subjects() -> frozenset[str]:
    return frozenset(map(subject, MIRRORED))


def untested(source: Source) -> Iterable[object]:
    """A long module has a test that is named after it, or is in the table of those that have not; never both."""
    module = source.path.relative_to(ROOT / "tuisim").as_posix()
    is_tested = (
        module in subjects()
        or source.most_tokens[-1] <= LONG_TOKENS
        or len(source.token_lines) <= LONG_TOKENS
        or source.path.stem == "__init__"
    )
    if module not in TESTED_BESIDE:
        return [] if is_tested else [f"{len(source.token_lines)} tokens and no test"]
    beside = ROOT / "tests" / TESTED_BESIDE[module]
    return ["needs no exception"] if is_tested or not beside.is_file() else []


def hex_colors(source: Source) -> Iterable[object]:
    return (
        re.findall(r"#(?:[0-9a-fA-F]{3,4}){1,2}\b", source.text)
        if source.path.name not in WITH_COLORS
        else []
    )


def misnamed(source: Source) -> Iterable[object]:
    name = source.path.relative_to(ROOT / "tests").as_posix()
    return ["named after no module"] if bool(subject(source.path)) == (name in OF_NO_MODULE) else []


@cache
def textual_names() -> frozenset[str]:
    """The private names that Textual's own files give to attributes, methods and functions."""
    folder = Path(textual.__file__).parent
    text = "".join(path.read_text(encoding="utf-8") for path in sorted(folder.rglob("*.py")))
    return frozenset(re.findall(r"(?:self\.|def )(_[a-z]\w+)", text))


def private_names_of_textual(source: Source) -> Iterable[object]:
    """Imports of private modules and names, and private attributes of objects other than `self`."""
    own = {"self", "cls", *OTHERS_OWN}
    for node in source.nodes:
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("textual"):
            yield from (
                name
                for name in (*str(node.module).split("."), *_aliases(node))
                if name.startswith("_")
            )
        elif isinstance(node, ast.Import):
            yield from (
                name for name in _aliases(node) if name.startswith("textual") and "._" in name
            )
    for one in source.attributes:
        # Named tuples have `_replace` as well.
        if one.attr in textual_names() - {"_replace"} and ast.unparse(one.value) not in own:
            yield ast.unparse(one)


def _aliases(node: ast.Import | ast.ImportFrom) -> list[str]:
    return [alias.name for alias in node.names]


def inner_parts_of_rooms(source: Source) -> Iterable[object]:
    """Imports of modules of other rooms that are none of their doors."""
    for room, module in entered(source):
        if module not in door_of(room):
            yield f"{room}: {module}"


def readers_of_python(source: Source) -> Iterable[object]:
    modules = {
        name
        for node in source.nodes
        if isinstance(node, ast.Import | ast.ImportFrom)
        for name in (
            [node.module]
            if isinstance(node, ast.ImportFrom)
            else [alias.name for alias in node.names]
        )
    }
    return modules & {"ast", "dis", "symtable"}


def slow_data_classes(source: Source) -> Iterable[object]:
    """Imports of Python's own data class, which is compiled at each start."""
    for node in source.nodes:
        if (
            isinstance(node, ast.ImportFrom)
            and node.module == "dataclasses"
            and "dataclass" in _aliases(node)
        ):
            yield node.lineno


TERMINAL = python_files("tuisim/terminal")
MAY_REACH_TEXTUAL = [*TERMINAL, *python_files("tuisim/app"), *python_files("tuisim/web")]
OUTSIDE_TERMINAL = [path for path in PACKAGE if path not in TERMINAL]


def test_the_terminal_package_exports_at_most_12_documented_names() -> None:
    assert len(terminal.__all__) <= 12
    assert all(import_module(f"tuisim.terminal.{name}").__doc__ for name in terminal.__all__)


RULES: dict[str, tuple[Callable[[Source], Iterable[object]], list[Path]]] = {
    "files are small": (large_files, CODE),
    "functions are small": (large_functions, CODE),
    "broad excepts say why": (unexplained_broad_excepts, CODE),
    "public names have docstrings": (bare_names, PACKAGE),
    "nothing is left open and no machine is named": (open_ends_and_machines, [*CODE, *PROSE]),
    "lines are split by source_lines": (other_line_splits, PACKAGE),
    "commands print by echo": (prints, python_files("tuisim/commands")),
    "core has no clock and no global random": (
        clocks_and_global_random,
        python_files("tuisim/engine/core"),
    ),
    "no test is skipped": (skipped_tests, TESTS),
    "long modules have tests of their own": (untested, PACKAGE),
    "tests are named after modules": (misnamed, MIRRORED),
    "colours have names": (hex_colors, [*PACKAGE, *sorted((ROOT / "tuisim").rglob("*.tcss"))]),
    "private names of Textual are in one module": (
        private_names_of_textual,
        [path for path in MAY_REACH_TEXTUAL if path.name != "textual_internals.py"],
    ),
    "data classes start fast": (
        slow_data_classes,
        [path for path in OUTSIDE_TERMINAL if path.name not in ("data_class.py", "spec_fields.py")],
    ),
    "rooms are entered by their doors": (inner_parts_of_rooms, PACKAGE),
    "programs are read in their room": (
        readers_of_python,
        # Expressions and literals in logs are no programs.
        [
            path
            for path in PACKAGE
            if not path.is_relative_to(ROOT / "tuisim" / "programs")
            and not path.is_relative_to(ROOT / "tuisim" / "engine")
            and path.name not in ("syntax_tree.py", "expressions.py", "json_rows.py")
        ],
    ),
}


@pytest.mark.parametrize("rule", RULES)
def test_each_rule_of_the_code_is_kept_in_every_file(rule: str) -> None:
    find, paths = RULES[rule]
    found = {str(path.relative_to(ROOT)): list(find(source(path))) for path in paths}
    assert paths
    assert {name: places for name, places in found.items() if places} == {}


def test_names_against_the_style_are_no_more_than_before() -> None:
    names = count_faults(map(source, PACKAGE))
    assert {
        kind: f"{len(names[kind])} above {most}"
        for kind, most in WORDS["most"].items()
        if len(names[kind]) > most
    } == {}


def test_no_unknown_file_is_tracked_at_the_top_level() -> None:
    # In a copy without git, what is there was tracked.
    if (ROOT / ".git").exists():
        done = subprocess.run(
            ["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True
        )
        tracked = {path.split("/")[0].strip('"') for path in done.stdout.split("\n") if path}
        assert tracked - TOP_LEVEL == set()


def tool(*words: str) -> str:
    """Run a checker over the project and return what it complains about."""
    done = subprocess.run(
        [sys.executable, "-m", *words], cwd=ROOT, capture_output=True, text=True, check=False
    )
    return "" if done.returncode == 0 else done.stdout + done.stderr


def test_every_name_that_a_room_exports_is_used_by_another_room() -> None:
    used = {place for path in PACKAGE for place in entered(source(path))}
    doors = {(room, name) for room in list_rooms(but=OPEN) for name in door_of(room)}
    assert doors == used


def test_imports_between_rooms_go_one_way(tmp_path: Path) -> None:
    contracts = tmp_path / "contracts.toml"
    contracts.write_text(write_contracts(), encoding="utf-8")
    program = (
        "import sys; from importlinter.cli import lint_imports; "
        "sys.exit(lint_imports(config_filename=sys.argv[1], no_cache=True))"
    )
    done = subprocess.run(
        [sys.executable, "-c", program, str(contracts)],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr


def test_ruff_finds_nothing() -> None:
    assert tool("ruff", "check", "--no-cache", ".") == ""


@pytest.mark.slow
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


@pytest.mark.parametrize("module", ["tuisim.engine.runtime", "tuisim.engine.shim"])
def test_the_process_of_a_program_imports_no_heavy_module(module: str) -> None:
    program = (
        f"import importlib, pkgutil, sys; package = importlib.import_module({module!r})\n"
        f"[importlib.import_module(m.name) for m in pkgutil.walk_packages(package.__path__, {module + '.'!r})"
        " if not m.name.endswith('__main__')]\n"
        f"print(*(set({CHILD_MAY_NOT_LOAD!r}) & set(sys.modules)))"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True, check=True
    )
    assert done.stdout.split() == []


def test_help_imports_no_heavy_module() -> None:
    program = "import sys; from tuisim.cli import run_command\ntry: run_command(['--help'])\nexcept SystemExit: pass\n"
    program += "print('LOADED', *sys.modules)"
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True, check=True
    )
    loaded = done.stdout.split("LOADED")[1].split()
    assert not {*HELP_MAY_NOT_LOAD, "tuisim.commands.run", "tuisim.commands.listings"} & set(loaded)
