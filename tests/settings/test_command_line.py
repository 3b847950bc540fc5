"""Completion in bash, zsh and fish, and the tree of commands that it and the help rest on."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import click
import pytest

from tests.cases import cases
from tests.conftest import ROOT, Command
from tuisim.cli import COMMANDS, run_command
from tuisim.settings import command_line
from tuisim.settings.command_line import Group

ASKED = {
    "commands": ("ru", ["run", "runs"]),
    "every command": ("", list(COMMANDS)),
    "options of the default command": ("--se", ["--sensornoise", "--seed", "--settings"]),
    "options after a program": ("prog.py --ba", ["--background", "--background-fit"]),
    "a program or a command": ("pro", ["programs", "profiles", "prog.py"]),
    "an example or a file": ("run lo", ["log_greys", "log.csv"]),
    "a value": ("run --walls ", ["on", "off"]),
    "a column to stop at": ("run prog.py --break left_re", ["left_red", "left_red_pc"]),
    "a column of a log": ("log events last --when gyro_", ["gyro_deg", "gyro_rate_dps"]),
    "a name": ("run -b Grey_b", ["Grey_bands"]),
    "a profile": (
        "run --profile ",
        ["robolab", "nbev3devsim", "ev3", "lego-micropython", "pybricks4"],
    ),
    "actions": ("runs re", ["rerun"]),
    "options of an action": ("runs export --", ["--out", "--telemetry", "--help"]),
    "options of the default action": ("runs --js", ["--json"]),
    "subcommands of log": ("log p", ["plot"]),
    "options of a subcommand": ("log bands --f", []),
    "a choice": ("log integrate --between ", ["hold", "linear"]),
    "a robot to print": ("robots Small_Robot_", ["Small_Robot_Wide_Eyes"]),
    "arguments of the program": ("run prog.py -- --se", ["--se"]),
}
"""What is typed after `tuisim`, and what is offered."""


def asked(shell: str, typed: str) -> dict[str, str]:
    """The variables with which the script of a shell asks."""
    words = ["tuisim", *typed.split()]
    incomplete = "" if typed.endswith(" ") or not typed else words[-1]
    count = len(words) - (1 if incomplete else 0)
    where = incomplete if shell == "fish" else str(count)
    return {
        "_TUISIM_COMPLETE": f"{shell}_complete",
        "COMP_WORDS": " ".join(words),
        "COMP_CWORD": where,
    }


def offered(shell: str, said: str) -> list[str]:
    """The words in an answer."""
    lines = [line for line in said.split("\n") if line]
    if shell == "zsh":
        return lines[1::3]
    return [line.partition(",")[2].partition("\t")[0] for line in lines]


@pytest.mark.quick_cases("*-bash", "a value-*")
@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
@cases("typed, words", ASKED)
def test_each_shell_completes_the_words_of_a_command(
    shell: str,
    typed: str,
    words: list[str],
    here: Command,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    for name in ("prog.py", "log.csv"):
        (tmp_path / name).touch()
    for name, value in asked(shell, typed).items():
        monkeypatch.setenv(name, value)
    assert offered(shell, here().stdout) == words


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_completion_prints_a_script_for_each_shell(shell: str, here: Command) -> None:
    done = here("completion", shell)
    assert (done.returncode, f"{shell}_complete" in done.stdout) == (0, True)


@pytest.mark.slow
def test_bash_completes_a_subcommand_with_the_printed_script(tmp_path: Path) -> None:
    (tmp_path / "tuisim").write_text(f'#!/bin/sh\nexec "{sys.executable}" -m tuisim "$@"\n')
    (tmp_path / "tuisim").chmod(0o755)
    script = (
        'eval "$(tuisim completion bash)"; COMP_WORDS=(tuisim log pl); COMP_CWORD=2;'
        ' _tuisim_completion tuisim; echo "${COMPREPLY[@]}"'
    )
    done = subprocess.run(
        ["bash", "-c", script],
        env={**os.environ, "PATH": f"{tmp_path}:{os.environ['PATH']}", "PYTHONPATH": str(ROOT)},
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.stdout == "plot\n", done.stderr


def tree(
    command: click.Command, path: tuple[str, ...] = ()
) -> Iterator[tuple[tuple[str, ...], click.Command]]:
    """Yield every command with its path."""
    yield path, command
    if isinstance(command, Group):
        for name in command.listing:
            yield from tree(command.load(name), (*path, name))


EVERY = [found for name, entry in COMMANDS.items() for found in tree(entry.load(), (name,))]


@pytest.mark.parametrize("path, command", EVERY, ids=[" ".join(path) for path, _ in EVERY])
def test_help_fits_a_terminal_and_lists_the_options_of_the_command(
    path: tuple[str, ...], command: click.Command, here: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    done = here(*path, "--help")
    assert done.returncode == 0
    assert [line for line in done.stdout.split("\n") if len(line) > 80] == []
    options = [
        param for param in command.params if isinstance(param, click.Option) and not param.hidden
    ]
    assert [option.opts[0] for option in options if option.opts[0] not in done.stdout] == []
    words = " ".join(done.stdout.split())
    assert [option.opts[0] for option in options if not option.help] == []
    assert [option.opts[0] for option in options if _squeeze(option.help) not in words] == []


def _squeeze(text: str | None) -> str:
    return " ".join((text or "").split())


def test_each_command_in_the_table_has_its_own_name() -> None:
    assert [name for name, entry in COMMANDS.items() if entry.load().name != name] == []


def test_log_without_a_subcommand_names_the_subcommands(capsys: pytest.CaptureFixture[str]) -> None:
    assert run_command(["log"]) == 2
    assert capsys.readouterr().err.startswith(
        "tuisim: log: no command given (one of summary, bands, "
    )


@pytest.mark.parametrize(
    ("words", "found"),
    [
        ("", ""),
        ("bands a.csv", "bands a.csv"),
        ("--help", "--help"),
        ("--json bands a.csv", "bands --json a.csv"),
    ],
)
def test_options_may_stand_before_the_command(words: str, found: str) -> None:
    group = COMMANDS["log"].load()
    assert isinstance(group, Group)
    context = click.Context(group, **group.context_settings)
    assert group.insert_command(context, words.split()) == found.split()


def test_drop_options_removes_options_with_their_values_from_the_words() -> None:
    words = ("mark", "--resume", "a.py", "--jobs", "2", "--keep=all", "--seeds", "0")
    options = [click.Option(["--resume"], is_flag=True), click.Option(["--jobs"])]
    with click.Context(click.Command("mark")) as context:
        context.meta[command_line._WORDS] = words
        left = command_line.drop_options([*options, click.Option(["--keep"])])
    assert left == ["mark", "a.py", "--seeds", "0"]
