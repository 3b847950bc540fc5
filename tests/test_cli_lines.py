"""Command and magic lines and what they parse to, as recorded in `cli_lines.jsonl`."""

from __future__ import annotations

import dataclasses
import importlib
import json
import shlex
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from tuisim import __version__
from tuisim.base.errors import ConfigError
from tuisim.cli import run_command
from tuisim.commands.runs import export, list_runs, rerun_runs, rm, show
from tuisim.engine.runs.store import RunStore
from tuisim.settings.magic_line import parse_line
from tuisim.settings.options import Settings

TABLE = Path(__file__).with_name("cli_lines.jsonl")
ROWS = [json.loads(line) for line in TABLE.read_text(encoding="utf-8").split("\n") if line]

MOST_CHARACTERS = 40
"""Of what a command prints."""
RUN_OPTIONS = (
    "export",
    "telemetry",
    "timeout",
    "input",
    "breaks",
    "watches",
    "break_then",
    "all",
    "json",
)
RUN_DEFAULTS = {"timeout": 600.0, "break_then": "go"}
LOG_OPTIONS = (
    "words",
    "time",
    "unit",
    "value",
    "variable",
    "telemetry",
    "json",
    "out",
    "at",
    "hysteresis",
    "between",
    "width",
    "period",
    "expression",
    "facets",
    "marks",
    "from",
    "to",
    "against",
    "when",
    "size",
)
LOG_DEFAULTS = {"between": "hold", "width": 5}

FILES = {
    "prog.py": "print('Number: 1')\n",
    "other.py": "print('Number: 2')\n",
    "magic.py": "# %%sim_magic_preloaded -b Loop -x 700 -OHR\nprint(gyro.angle)\n",
    "lab.toml": 'program = "prog.py"\narguments = ["from", "a world"]\nseed = 7\npanels = ["chart"]\n',
    "robot.json": "{}",
    "robot.toml": "wheel_diameter_mm = 40\n",
    "box.toml": "[[obstacle]]\nx_mm = 900\ny_mm = 500\nwidth_mm = 200\nheight_mm = 100\n",
    "log.csv": "time,left,right\n0,1,2\n1,2,3\n",
}


class Stop(Exception):
    """Raised where a command would begin its work, with what it was told to do."""

    def __init__(self, **found: Any) -> None:
        super().__init__(found)
        self.found = found


def plain(value: Any) -> Any:
    """A value as JSON has it; of a magic line, the words that are not at their defaults."""
    match value:
        case Settings():
            bare = Settings()
            return {path: plain(value[path]) for path in value.given if value[path] != bare[path]}
        case SimpleNamespace():
            defaults = vars(parse_line("", "sim_magic"))
            return {name: plain(one) for name, one in vars(value).items() if one != defaults[name]}
        case str() | int() | float() | bool() | None:
            return value
        case Path():
            return str(value)
        case dict():
            return {name: plain(one) for name, one in value.items()}
        case list() | tuple() | set() | frozenset():
            return [plain(one) for one in value]
    return {field.name: plain(getattr(value, field.name)) for field in dataclasses.fields(value)}


def chosen(arguments: Any, names: tuple[str, ...], defaults: dict[str, Any]) -> dict[str, Any]:
    """The named attributes that are there and not at their defaults."""
    found = {name: plain(getattr(arguments, name, None)) for name in names}
    return {
        name: one
        for name, one in found.items()
        if one not in (None, "", [], False, defaults.get(name))
    }


def _run_one(one: Any, arguments: Any, *_: Any) -> Any:
    program = {"program": one.program.name, "arguments": list(one.program.arguments)}
    raise Stop(
        **program, settings=plain(one.settings), **chosen(arguments, RUN_OPTIONS, RUN_DEFAULTS)
    )


def _run_app(app: Any) -> int:
    settings = {} if app.settings is None else plain(app.settings)
    world = app.world_file.name if app.world_file else None
    replay = app.replay.number if app.replay else None
    given = {
        "speed": app.speed,
        "panels_on": sorted(app.panels_on),
        "colors": app.colors,
        "quiet": app.quiet,
    }
    program = app.program.name if app.program else None
    raise Stop(program=program, world=world, replay=replay, settings=settings, app=given)


def _log(action: str) -> Any:
    def work(arguments: Any) -> int:
        raise Stop(action=action, **chosen(arguments, LOG_OPTIONS, LOG_DEFAULTS))

    return work


def _told(action: str, *names: str) -> Any:
    def work(*values: Any, **named: Any) -> Any:
        found = dict(zip(names, values, strict=True)) | named
        raise Stop(
            action=action,
            **{name: plain(one) for name, one in found.items() if not name.startswith("_")},
        )

    return work


def _run_action(action: str, work: Any) -> Any:
    def record(words: Any = (), older_than: Any = None, **named: Any) -> int:
        if not words and action != "list" and older_than is None:
            return int(
                work(words=words, **({"older_than": None} if action == "rm" else {}), **named)
            )
        match action:
            case "list":
                raise Stop(action=action, **named)
            case "show" | "rerun":
                raise Stop(action=action, run=words[0], **named)
            case "rm":
                raise Stop(action=action, words=plain(words), age=older_than)
        raise Stop(action=action, words=plain(words), **named)

    return record


def watch(patch: pytest.MonkeyPatch) -> None:
    """Have every command stop where its work would begin."""
    from tuisim.commands.log import SUBCOMMANDS

    for stream in (sys.stdin, sys.stdout):
        patch.setattr(stream, "isatty", lambda: True)
    patch.setattr("tuisim.app.app.run_app", _run_app)
    patch.setattr(
        "tuisim.app.analyser.app.run_analyser", lambda wanted: _told("analyse", "log")(wanted)
    )
    patch.setattr("tuisim.commands.run._run_one", _run_one)
    for name, entry in SUBCOMMANDS.items():
        module, _, function = entry.path.partition(":")
        patch.setattr(
            importlib.import_module(f"tuisim.commands.logs.{module}"), function, _log(name)
        )
    for command in (list_runs, show, rm, rerun_runs, export):
        patch.setattr(command, "callback", _run_action(command.name or "", command.callback))
    patch.setattr("tuisim.commands.kernel._list", _told("list", "_kernels"))
    patch.setattr("tuisim.commands.kernel._install", _told("install", "_manager", "place", "name"))
    patch.setattr("tuisim.commands.kernel._remove", _told("remove", "folders", "name"))


def outcome(line: str, capsys: pytest.CaptureFixture[str]) -> Any:
    """What a line parses to: settings, an exit code with what was printed, or an error."""
    words = shlex.split(line)
    if words[0].startswith("%"):
        try:
            return plain(parse_line(line.partition(" ")[2], words[0].lstrip("%")))
        except ConfigError as error:
            return {"error": str(error)}
    try:
        code = run_command(words)
    except Stop as stop:
        return stop.found
    except SystemExit as left:
        code = int(left.code or 0)
    out, err = capsys.readouterr()
    return {
        "exit": code,
        "out": out.partition("\n")[0][:MOST_CHARACTERS],
        "err": err.removesuffix("\n"),
    }


def prepared(folder: Path, patch: pytest.MonkeyPatch) -> None:
    """Fill a folder with what the lines name."""
    for name, text in FILES.items():
        (folder / name).write_text(text)
    patch.chdir(folder)
    patch.setenv("TUISIM_DEBUG", "1")
    patch.setenv("JUPYTER_DATA_DIR", str(folder / "jupyter"))
    patch.setenv("COLUMNS", "80")


@pytest.fixture(scope="module")
def stored(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A home with one stored run."""
    home = tmp_path_factory.mktemp("lines")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("TUISIM_HOME", str(home))
        (home / "prog.py").write_text(FILES["prog.py"])
        assert run_command(["run", str(home / "prog.py")]) == 0
        assert RunStore().load_run("last").number == 1
    return home


def neutral(found: Any) -> Any:
    """An outcome without folders of this machine, and without the version."""
    text = json.dumps(found)
    for own, name in ((str(Path.cwd()), "HERE"), (sys.prefix, "PREFIX"), (__version__, "VERSION")):
        text = text.replace(own, name)
    return json.loads(text)


def test_each_recorded_command_line_is_parsed_to_the_recorded_settings(
    tmp_path: Path,
    stored: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setenv("TUISIM_HOME", str(stored))
    prepared(tmp_path, monkeypatch)
    watch(monkeypatch)
    for row in ROWS:
        line = row["line"]
        capsys.readouterr()
        found = neutral(outcome(line, capsys))
        if "refused" not in row:
            assert found == row["to"], line
            continue
        assert found.get("exit", 2) == 2, line
        assert found.get("out", "") == "", line
        said = found.get("err", found.get("error"))
        assert [name for name in row["refused"] if name not in said] == [], line
