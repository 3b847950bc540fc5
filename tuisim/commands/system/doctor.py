"""`tuisim doctor`: what the terminal and the machine offer, and what to do where they offer too little."""

from __future__ import annotations

import locale
import os
import platform
import re
import shutil
import sys
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path
from textwrap import wrap

from tuisim import __version__
from tuisim.base.errors import ConfigError, TuisimError
from tuisim.base.folders import backgrounds_folder, home_folder, programs_folder
from tuisim.commands.echo import echo, echo_json
from tuisim.commands.system import diagnosis
from tuisim.commands.system.diagnosis import Finding, FindingState, prevents_use
from tuisim.notebook.kernel import find_old_simulator
from tuisim.settings.command_line import AS_JSON, command, option

EXIT_PREVENTED = 1
_WIDTH = 78
_MARKS = {FindingState.OK: "ok", FindingState.ADVICE: "!", FindingState.PROBLEM: "FAIL"}
_EXACTLY = re.compile(r"([A-Za-z0-9._-]+)\s*(?:==([^;,\s]+))?")


@command(
    AS_JSON,
    option("--reset", is_flag=True, help="Restore a terminal that a killed app has left unusable."),
    instead={"--clean": "tuisim removes the files of killed processes when it runs again"},
    help="""Check the terminal and the machine, for use and for bug reports.

    Each line shows a result and, after ->, what to do about it. The exit code is 0 unless something prevents the
    use of tuisim.

    If a killed app has left the terminal without an echo or with a hidden cursor, type `tuisim doctor --reset` and
    press ctrl+j, even if you cannot see what you type.
    """,
)
def doctor(as_json: bool, reset: bool) -> int:
    """Print the report, or restore the terminal.

    Raises:
        ConfigError: there is no terminal to restore.
    """
    if reset:
        _restore()
        return 0
    findings = [*_check_terminal(os.environ), *_check_machine()]
    prevented = prevents_use(findings)
    if as_json:
        facts = {"usable": not prevented, "findings": [asdict(finding) for finding in findings]}
        echo_json({"tuisim": __version__, **facts})
    else:
        _print(findings)
    return EXIT_PREVENTED if prevented else 0


def _print(findings: list[Finding]) -> None:
    echo(f"tuisim {__version__}")
    widest = max(len(finding.name) for finding in findings)
    for finding in findings:
        first, *rest = wrap(finding.value, _WIDTH - widest - 8, break_on_hyphens=False) or [""]
        echo(f"{_MARKS[finding.state]:4}  {finding.name:{widest}}  {first}")
        advice = wrap(finding.advice, _WIDTH - widest - 11, break_on_hyphens=False)
        for line in (
            *rest,
            *(f"{'  ' if number else '->'} {text}" for number, text in enumerate(advice)),
        ):
            echo(f"{'':{widest + 8}}{line}")
    echo(
        "Something prevents the use of tuisim: see FAIL."
        if prevents_use(findings)
        else "tuisim can be used."
    )


@contextmanager
def _open_terminal() -> Iterator[int | None]:
    """Yield the open terminal of this process, also if its output is redirected.

    Yield None if there is none, or if this process is in its background.
    """
    try:
        fd = os.open("/dev/tty", os.O_RDWR | os.O_NOCTTY)
    except OSError:
        yield None
        return
    try:
        # The system stops a job in the background that changes its terminal.
        yield fd if os.tcgetpgrp(fd) == os.getpgrp() else None
    finally:
        os.close(fd)


def _restore() -> None:
    # On demand: this and the report are all that the command needs of the app.
    from tuisim.terminal.probe import restore_terminal

    with _open_terminal() as fd:
        if fd is None:
            raise ConfigError("there is no terminal to restore", key="--reset")
        restore_terminal(fd, os.environ.get("TERM", ""))
    echo("The terminal has been restored.")


def _check_terminal(environment: Mapping[str, str]) -> list[Finding]:
    is_remote = "SSH_CONNECTION" in environment or "SSH_TTY" in environment
    with _open_terminal() as fd:
        if fd is None:
            return [diagnosis.judge_no_terminal(), _check_locale(environment)]
        return _ask_terminal(fd, environment, is_remote)


def _ask_terminal(fd: int, environment: Mapping[str, str], is_remote: bool) -> list[Finding]:
    from tuisim.terminal.picture_mode import describe_terminal

    report = describe_terminal(fd, environment)
    if report is None:
        return [diagnosis.judge_no_terminal(), _check_locale(environment)]
    term = environment.get("TERM", "")
    size = os.get_terminal_size(fd)
    return [
        diagnosis.judge_terminal(report.name, term, is_remote=is_remote),
        diagnosis.judge_size(size.columns, size.lines),
        diagnosis.judge_colors(
            report.colors, is_remote=is_remote, is_fixed=report.has_fixed_colors
        ),
        diagnosis.judge_cells(
            report.cells,
            term if report.is_limited else "",
            _find_locale_variable(report.environment),
        ),
        diagnosis.judge_graphics(report.protocol, has_colors=report.has_colors),
        *([diagnosis.judge_latency(report.latency_s)] if report.is_asked else []),
        _check_locale(environment),
    ]


def _check_locale(environment: Mapping[str, str]) -> Finding:
    return diagnosis.judge_locale(_find_locale_variable(environment), locale.getencoding())


def _find_locale_variable(environment: Mapping[str, str]) -> str:
    """Return the variable that decides the locale with its value; empty if none is set."""
    names = (name for name in ("LC_ALL", "LC_CTYPE", "LANG") if environment.get(name))
    return next((f"{name}={environment[name]}" for name in names), "")


def _check_machine() -> list[Finding]:
    home = home_folder()
    why_not = _explain_unwritable(home)
    findings = [
        diagnosis.judge_system(platform.system(), platform.release()),
        diagnosis.judge_python(sys.version_info[:3], sys.executable),
        diagnosis.home_finding(str(home), why_not),
        diagnosis.judge_assets(_explain_missing_assets()),
    ]
    if not why_not:
        findings.append(diagnosis.store_finding(*_store(home)))
    return [
        *findings,
        _check_textual(),
        *diagnosis.judge_dependencies(_list_requirements()),
        *diagnosis.judge_simulator(str(find_old_simulator() or "")),
    ]


def _check_textual() -> Finding:
    from tuisim.terminal.textual_internals import describe_textual

    return diagnosis.judge_textual(*describe_textual())


def _explain_unwritable(folder: Path) -> str:
    """Return why a file cannot be created in a folder, which need not exist yet; empty if it can."""
    place = folder
    while not place.exists() and place != place.parent:
        place = place.parent
    try:
        with tempfile.TemporaryFile(dir=place):
            return ""
    except OSError as error:
        return f"cannot be written ({error.strerror or error})"


def _explain_missing_assets() -> str:
    try:
        backgrounds_folder()
        programs_folder()
    except TuisimError as error:
        return str(error)
    return ""


def _store(home: Path) -> tuple[int, int, int]:
    """Return the number of stored runs, their size and the free space on the disk in bytes."""
    from tuisim.engine.runs.store import count_bytes

    try:
        runs = [entry for entry in (home / "runs").iterdir() if entry.is_dir()]
    except OSError:
        runs = []
    place = next(parent for parent in (home, *home.parents) if parent.exists())
    return len(runs), sum(map(count_bytes, runs)), shutil.disk_usage(place).free


def _list_requirements() -> list[tuple[str, str, str]]:
    """Return the packages that tuisim needs: name, required version and installed version of each."""
    from importlib.metadata import PackageNotFoundError, requires

    try:
        lines = requires("tuisim") or []
    except PackageNotFoundError:
        return [("tuisim", "", "")]
    matches = [
        match for line in lines if "extra ==" not in line and (match := _EXACTLY.match(line))
    ]
    return [(match[1], match[2] or "", _read_version(match[1])) for match in matches]


def _read_version(name: str) -> str:
    from importlib.metadata import PackageNotFoundError, version

    try:
        return version(name)
    except PackageNotFoundError:
        return ""
