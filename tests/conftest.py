"""What all tests share: a home of their own, so that no test reads or writes the user's runs."""

from __future__ import annotations

import gc
import os
import subprocess
import sys
from collections import Counter, OrderedDict
from collections.abc import Callable, Generator, Hashable, Iterator
from contextlib import suppress
from dataclasses import replace
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, settings

from tests.running import PATIENCE_S, Done, Run, Start, over
from tuisim.base.atomic import make_private_folder
from tuisim.base.folders import cache_folder
from tuisim.base.memory import return_freed_blocks
from tuisim.base.source import Program
from tuisim.cli import run_command
from tuisim.engine import mat_cache
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.profile import PROFILES
from tuisim.engine.core.spec import NoiseSpec, PenSpec, RobotSpec, RunSpec, WorldSpec
from tuisim.engine.mat_cache import FieldFiles
from tuisim.engine.runs import handle as run_handle
from tuisim.engine.runs.child import process
from tuisim.engine.runs.child.warm import Template
from tuisim.engine.runs.handle import RunHandle, RunOptions, start_run

ROOT = Path(__file__).resolve().parent.parent
MATS = {name: getattr(mat_cache, name) for name in ("_in_use", "_store", "_checksum")}
"""How mats are looked for, stored and checked by users."""
TEMPLATES = process.MAX_TEMPLATES, run_handle._build_template_key
"""How many templates users have, and for which runs."""
ALONE = 2
"""Runs of a robot and world before a template pays."""

LONGEST = {
    "test_app_monkey.py",
    "test_live_robot_page.py",
    "test_mark_attacks.py",
    "test_rules.py",
    "test_runs_damaged.py",
    "test_server_page.py",
}
"""Files that take the most time; types are checked in that of the rules."""

settings.register_profile(
    "quick",
    max_examples=15,
    deadline=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
settings.register_profile("thorough", settings.get_profile("quick"), max_examples=100)
settings.load_profile("quick")

# Hundreds of commands and children import the same modules: where bytecode is kept, each is compiled once.
sys.dont_write_bytecode = False
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)


def pytest_sessionstart() -> None:
    """Do not look for garbage among the thousands of tests that are collected: it costs as much as the tests."""
    # Not when this is imported: programs that import it, too, would grow without a bound.
    gc.disable()


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Begin with the files whose slow tests take minutes: at the end, one worker would wait for another's."""
    items.sort(key=lambda item: item.path.name not in LONGEST)


def pytest_collection_finish() -> None:
    """Leave what all tests share out of every search for garbage, and search less often."""
    gc.freeze()
    gc.set_threshold(50_000, 20, 20)
    gc.enable()


@pytest.fixture(scope="session", autouse=True)
def _memory_of_earlier_tests_is_given_back() -> None:
    """Keep as little freed memory as an app does: hundreds of them would keep gigabytes."""
    return_freed_blocks()


@pytest.fixture(scope="session", autouse=True)
def _no_test_keeps_the_garbage_of_others() -> Iterator[None]:
    """Let nothing leave what is there out of every search for garbage: an app does that, which is alone in its process.

    Otherwise the apps of earlier tests, and the files that they have mapped, stay until the end.
    """
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(gc, "freeze", lambda: None)
        yield


@pytest.hookimpl(wrapper=True)
def pytest_pycollect_makeitem() -> Generator[None, Any, Any]:
    """Mark the slow cases of a table: `quick_cases` names those that are quick, or `slow_cases` those that are not."""
    made = yield
    if isinstance(made, list):
        for kind in ("quick_cases", "slow_cases"):
            if made and (mark := made[0].get_closest_marker(kind)):
                _mark_slow_cases(made, mark)
    return made


def _mark_slow_cases(cases: list[pytest.Function], mark: pytest.Mark) -> None:
    ids = [case.callspec.id for case in cases]
    if missing := [name for name in mark.args if not any(fnmatchcase(at, name) for at in ids)]:
        raise pytest.UsageError(
            f"{cases[0].originalname}: no case {', '.join(missing)} among {', '.join(ids)}"
        )
    for case, at in zip(cases, ids, strict=True):
        is_named = any(fnmatchcase(at, name) for name in mark.args)
        if is_named == (mark.name == "slow_cases"):
            case.add_marker(pytest.mark.slow)


Command = Callable[..., "subprocess.CompletedProcess[str]"]
"""`tuisim(*words)`: runs the real command in an own folder; `environment` adds variables."""


@pytest.fixture(scope="session", autouse=True)
def shared_home(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """One home for the whole session, because preparing a mat for each test would be slow."""
    folder = tmp_path_factory.mktemp("home")
    make_private_folder(folder / "cache")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("TUISIM_HOME", str(folder))
        patch.delenv("TUISIM_ASSETS", raising=False)
        yield folder


@pytest.fixture(scope="session", autouse=True)
def _forked_children() -> Iterator[None]:
    """Fork the children of all runs from the warm process, also the first."""
    process.start_warm_process()
    yield
    process.end_warm_process()


@pytest.fixture(scope="session", autouse=True)
def _runs_alike_are_forked_from_a_template() -> Iterator[None]:
    """Fork the third run of a robot and world, and all later ones, from a template, as batches, marking and apps do.

    The files of the mat may lie in any home, because all homes have the same ones.
    """
    counts: Counter[Hashable] = Counter()
    build_key = TEMPLATES[1]

    def build_key_for_all_homes(program: Program, spec: RunSpec, field: FieldFiles) -> Hashable:
        files = [path.stat() for path in (field.pixels, *(path for _, path in field.sums))]
        somewhere = replace(field, pixels=Path(), sums=())
        return build_key(program, spec, somewhere), *(
            (file.st_ino, file.st_mtime_ns) for file in files
        )

    def start_child_of_many(
        folder: Path, lock_fd: int, cwd: str, run: Any, key: Hashable, of_many: bool, needs: Any
    ) -> Any:
        counts[key] += 1
        of_many = of_many or counts[key] > ALONE
        return process.start_child(folder, lock_fd, cwd, run, key, of_many, needs)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(process, "MAX_TEMPLATES", 12)
        patch.setattr(run_handle, "_build_template_key", build_key_for_all_homes)
        patch.setattr(run_handle, "start_child", start_child_of_many)
        yield


@pytest.fixture(scope="session", autouse=True)
def _mats_are_prepared_once(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Lay the same prepared mats into every home: to prepare one costs more than most tests.

    All workers use the same ones. A home that is removed changes the identity of their files, but not what is in them.
    """
    base = tmp_path_factory.getbasetemp()
    kept = (base.parent if "PYTEST_XDIST_WORKER" in os.environ else base) / "mats"
    kept.mkdir(exist_ok=True)
    in_use, store, checksum = MATS.values()
    checksums: dict[tuple[int, ...], int] = {}

    def checksum_once(descriptor: int) -> int:
        found = os.fstat(descriptor)
        written = found.st_ino, found.st_size, found.st_mtime_ns
        if written not in checksums:
            checksums[written] = checksum(descriptor)
        return checksums[written]

    def in_use_or_kept(path: Path, size: int) -> bool:
        if (
            path.is_relative_to(cache_folder())
            and not path.exists()
            and in_use(kept / path.name, size)
        ):
            with suppress(OSError):
                make_private_folder(path.parent)
                link(kept / path.name, path)
        found: bool = in_use(path, size)
        return found

    def store_and_keep(path: Path, array: Any) -> None:
        store(path, array)
        # Another worker may have been quicker.
        with suppress(FileExistsError):
            link(path, kept / path.name)

    def link(path: Path, other: Path) -> None:
        noted, _ = mat_cache._noted(path) or (0, ())
        os.link(path, other)
        # A file's identity changes when it is linked.
        for one in (path, other):
            mat_cache._note(one, noted, one.stat())

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(mat_cache, "_in_use", in_use_or_kept)
        patch.setattr(mat_cache, "_store", store_and_keep)
        patch.setattr(mat_cache, "_checksum", checksum_once)
        yield


@pytest.fixture
def real_mats(monkeypatch: pytest.MonkeyPatch) -> None:
    """Prepare mats as users do."""
    for name, real in MATS.items():
        monkeypatch.setattr(mat_cache, name, real)


@pytest.fixture
def real_forks(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Make templates only as users do, and set those of other tests aside."""
    templates: OrderedDict[Hashable, Template] = OrderedDict()
    monkeypatch.setattr(process._Starts, "templates", templates)
    monkeypatch.setattr(process, "MAX_TEMPLATES", TEMPLATES[0])
    monkeypatch.setattr(run_handle, "_build_template_key", TEMPLATES[1])
    monkeypatch.setattr(run_handle, "start_child", process.start_child)
    yield
    for template in templates.values():
        template.close()


@pytest.fixture
def real_start(monkeypatch: pytest.MonkeyPatch) -> None:
    """Start each child by itself, as the first one of a process is started."""
    monkeypatch.setattr(process, "_fork", lambda *_: None)


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty home for tests that look at what is stored."""
    folder = tmp_path / "home"
    monkeypatch.setenv("TUISIM_HOME", str(folder))
    return folder


@pytest.fixture(scope="session")
def root() -> Path:
    """The folder that holds the package, the mats and the programs."""
    return ROOT


@pytest.fixture
def here(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> Command:
    """As `tuisim`, but in this process, which saves the start of another one where that is not what is tested."""
    monkeypatch.chdir(tmp_path)

    def run(*words: object) -> subprocess.CompletedProcess[str]:
        try:
            code = run_command([str(word) for word in words])
        except SystemExit as left:
            # Help and version end the process that they are asked in.
            code = int(left.code or 0)
        said = capsys.readouterr()
        return subprocess.CompletedProcess([], code, said.out, said.err)

    return run


@pytest.fixture
def tuisim(tmp_path: Path) -> Command:
    """The real `tuisim` command, run in `tmp_path` with nothing on its stdin."""

    def run(*words: object, **environment: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [sys.executable, "-m", "tuisim", *map(str, words)],
            cwd=tmp_path,
            env={**os.environ, "PYTHONPATH": str(ROOT), **environment},
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=PATIENCE_S,
            check=False,
        )

    return run


@pytest.fixture
def start() -> Iterator[Start]:
    """`start(text, …)`: start a program; whatever still runs at the end of the test is killed."""
    handles: list[RunHandle] = []

    def begin(
        text: str,
        *,
        profile: str = "robolab",
        pose: tuple[float, float, float] = (150.0, 500.0, 0.0),
        noise: tuple[int, int] = (0, 0),
        seed: int = 0,
        prelude: str = "preloaded",
        background: str = "Grey_bands",
        pen: PenSpec | None = None,
        pen_marks: bool = False,
        solid: bool = False,
        **options: Any,
    ) -> RunHandle:
        world = WorldSpec(
            background=background,
            start=Pose(*pose),
            noise=NoiseSpec(*noise),
            pen_marks=pen_marks,
            solid=solid,
        )
        spec = RunSpec(RobotSpec(pen=pen or PenSpec()), world, PROFILES[profile], seed)
        options.setdefault("time_limit_s", 20.0)
        handle = start_run(Program("program.py", text, prelude), spec, RunOptions(**options))
        handles.append(handle)
        return handle

    yield begin
    for handle in handles:
        handle.close()


@pytest.fixture
def run(start: Start) -> Run:
    """`run(text, …)`: run a program to its end."""

    def finish(text: str, **how: Any) -> Done:
        return over(start(text, **how))

    return finish
