"""`tuisim doctor`: what the terminal and the machine offer, and what to do where they offer too little."""

from __future__ import annotations

import locale
import os
import platform
import re
import shutil
import sys
import tempfile
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict
from enum import StrEnum
from pathlib import Path
from textwrap import wrap

from tuisim import __version__
from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError, TuisimError
from tuisim.base.folders import backgrounds_folder, home_folder, programs_folder
from tuisim.commands.echo import AS_JSON, echo, echo_json
from tuisim.notebook.kernel import find_old_simulator
from tuisim.settings.command_line import command, option
from tuisim.terminal.picture_options import CellSet

# These functions are pure: `doctor` examines the machine, and they judge the results.

SMALLEST = (60, 18)
COMFORTABLE = (80, 24)
"""Columns and rows that the app needs, and the columns and rows for which it is designed."""
SLOW_S = 0.15
"""A user notices if the terminal takes longer to answer."""
LARGE_STORE_MB = 2000


class FindingState(StrEnum):
    """Whether a finding of `tuisim doctor` is good, could be better, or prevents the use of tuisim."""

    OK = "ok"
    ADVICE = "advice"
    """Usable; something could be better."""
    PROBLEM = "problem"
    """tuisim cannot be used until it is solved."""


@dataclass(frozen=True, slots=True)
class Finding:
    """One line of the report of `tuisim doctor`."""

    name: str
    value: str
    state: FindingState = FindingState.OK
    advice: str = ""
    """What to do about it."""


def judge_terminal(name: str, term: str, *, is_remote: bool) -> Finding:
    """Return a finding on which terminal this is.

    Args:
        name: The terminal's own name; empty if it is not known.
        term: The value of the variable TERM.
        is_remote: Whether the terminal is connected by SSH.
    """
    value = f"{name or 'no name'} (TERM={term or 'not set'}{', over SSH' if is_remote else ''})"
    if term in ("", "dumb", "unknown"):
        return Finding(
            "terminal",
            value,
            FindingState.ADVICE,
            "The terminal is unknown: export TERM=xterm-256color",
        )
    return Finding("terminal", value)


def judge_no_terminal() -> Finding:
    """Return the finding that there is no terminal."""
    advice = "The app needs a terminal; `tuisim run`, `batch`, `log` and notebooks do not"
    return Finding("terminal", "none", FindingState.ADVICE, advice)


def judge_colors(depth: str, *, is_remote: bool, is_fixed: bool = False) -> Finding:
    """Return a finding on the number of colours.

    Args:
        depth: The colour depth of the app: one of `COLOR_DEPTHS` other than `auto`.
        is_remote: Whether the terminal is connected by SSH.
        is_fixed: Whether TERM or NO_COLOR decides, so that COLORTERM changes nothing.
    """
    if depth == "truecolor":
        return Finding("colours", "truecolor (16 million)")
    if is_fixed:
        return Finding(
            "colours",
            f"{depth}, as TERM or NO_COLOR says",
            FindingState.ADVICE,
            "--colors chooses another number",
        )
    sent = "; SSH does not send this variable by itself" if is_remote else ""
    advice = f"If the terminal shows more, as most do: export COLORTERM=truecolor{sent}"
    return Finding("colours", depth, FindingState.ADVICE, advice)


_POINTS = {
    CellSet.HALF: "1 × 2 points in a cell",
    CellSet.QUADRANT: "2 × 2 points in a cell",
    CellSet.SEXTANT: "2 × 3 points in a cell",
    CellSet.OCTANT: "2 × 4 points in a cell",
    CellSet.BRAILLE: "2 × 4 dots in a cell",
    CellSet.ASCII: "letters and signs",
}


def judge_cells(cells: CellSet, term: str = "", variable: str = "") -> Finding:
    """Return a finding on the finest glyphs that the terminal is known to show.

    Args:
        cells: The glyphs.
        term: The value of TERM if it is the reason for no finer glyphs, else empty.
        variable: The variable that decides the locale, see `judge_locale`.
    """
    value = f"{cells} ({_POINTS[cells]})"
    if cells is CellSet.ASCII:
        advice = (
            f"TERM={term} reports no more than this; if the terminal shows more: --cells half"
            if term
            else f"Finer glyphs need UTF-8: {_use_utf8(variable)}"
        )
        return Finding("cells", value, FindingState.ADVICE, advice)
    if cells in (CellSet.HALF, CellSet.QUADRANT):
        return Finding(
            "cells",
            value,
            FindingState.OK,
            "Press V in the app to see whether the font shows finer ones",
        )
    return Finding("cells", value)


def judge_graphics(protocol: str, *, has_colors: bool = True) -> Finding:
    """Return a finding on the protocol by which the terminal shows pixels.

    Args:
        protocol: The protocol's name; empty if there is none.
        has_colors: Whether colours are allowed; without colours, there are no pixels.
    """
    why = "" if has_colors else ", as TERM or NO_COLOR says"
    return Finding("graphics", protocol or f"none{why}: the world is drawn with glyphs")


def judge_size(cols: int, rows: int) -> Finding:
    """Return a finding on the size of the terminal in cells."""
    value = f"{cols} × {rows}"
    for smallest, word in ((SMALLEST, "at least"), (COMFORTABLE, "better")):
        if cols < smallest[0] or rows < smallest[1]:
            return Finding(
                "size",
                value,
                FindingState.ADVICE,
                f"Enlarge the window to {word} {smallest[0]} × {smallest[1]}",
            )
    return Finding("size", value)


def judge_locale(variable: str, encoding: str) -> Finding:
    """Return a finding on the locale.

    Args:
        variable: The variable that decides the locale, with its value, such as `LANG=C.UTF-8`; empty if none is set.
        encoding: The encoding that Python uses.
    """
    value = f"{variable or 'not set'} ({encoding})"
    if encoding.lower().replace("-", "") != "utf8" or (variable and "utf" not in variable.lower()):
        return Finding("locale", value, FindingState.ADVICE, f"Use UTF-8: {_use_utf8(variable)}")
    return Finding("locale", value)


def _use_utf8(variable: str) -> str:
    """Return the shell command that selects UTF-8: it sets the variable that decides the locale."""
    return f"export {variable.partition('=')[0] or 'LANG'}=C.UTF-8"


def judge_latency(latency_s: float | None) -> Finding:
    """Return a finding on how long the terminal takes to answer.

    Args:
        latency_s: The time in seconds; None if it does not answer.
    """
    if latency_s is None:
        advice = "It does not answer, so tuisim cannot know what it shows: choose with --cells and --pixels"
        return Finding("latency", "no answer", FindingState.ADVICE, advice)
    value = f"{1000 * latency_s:.0f} ms" if latency_s >= 0.01 else f"{1000 * latency_s:.1f} ms"
    if latency_s > SLOW_S:
        return Finding(
            "latency",
            value,
            FindingState.ADVICE,
            "Slow link: --fps 5, --cells half and --pixels none send less",
        )
    return Finding("latency", value)


def judge_system(system: str, release: str) -> Finding:
    """Return a finding on the operating system, such as Linux."""
    value = f"{system} {release}"
    if system == "Linux":
        return Finding("system", value)
    if system == "Darwin":
        return Finding(
            "system",
            value,
            FindingState.ADVICE,
            "macOS is untested: please report what does not work",
        )
    return Finding("system", value, FindingState.PROBLEM, "tuisim needs Linux; on Windows use WSL")


def home_finding(folder: str, why_not: str) -> Finding:
    """Return a finding on the folder of runs, drafts and preferences.

    Args:
        folder: Its path.
        why_not: Why it cannot be written; empty if it can.
    """
    if why_not:
        advice = "Runs cannot be stored: fix the permissions, or export TUISIM_HOME=FOLDER"
        return Finding("home folder", f"{folder}: {why_not}", FindingState.PROBLEM, advice)
    return Finding("home folder", f"{folder} (writable)")


def store_finding(count: int, size_bytes: int, free_bytes: int) -> Finding:
    """Return a finding on the stored runs: their number, their size and the free space on the disk."""
    value = f"{count} runs, {size_bytes / 1e6:.1f} MB; {free_bytes / 1e9:.1f} GB free"
    if free_bytes < 100e6:
        return Finding(
            "store",
            value,
            FindingState.ADVICE,
            "The disk is almost full: tuisim runs rm --older-than 30d",
        )
    if size_bytes > LARGE_STORE_MB * 1e6:
        return Finding(
            "store", value, FindingState.ADVICE, "Large: tuisim runs rm --older-than 30d"
        )
    return Finding("store", value)


def judge_assets(why_not: str) -> Finding:
    """Return a finding on whether the mats and the examples are installed; `why_not` is empty if they are."""
    if why_not:
        return Finding(
            "mats", why_not, FindingState.PROBLEM, "Install tuisim again, or fix TUISIM_ASSETS"
        )
    return Finding("mats", "found")


def judge_dependencies(requirements: Iterable[tuple[str, str, str]]) -> list[Finding]:
    """Return findings on the packages that tuisim needs: one for all correct packages, and one for each other package.

    Args:
        requirements: For each package its name, the version that is required exactly or an empty text, and the
            installed version or an empty text.
    """
    findings = [_judge_dependency(*finding) for finding in requirements]
    good = ", ".join(
        f"{finding.name} {finding.value}"
        for finding in findings
        if finding.state is FindingState.OK
    )
    return [
        Finding("packages", good or "none"),
        *(finding for finding in findings if finding.state is not FindingState.OK),
    ]


def _judge_dependency(name: str, pinned: str, installed: str) -> Finding:
    if not installed:
        return Finding(
            name,
            "missing",
            FindingState.PROBLEM,
            "Install tuisim again: pip install --force-reinstall tuisim",
        )
    if pinned and installed != pinned:
        return Finding(
            name, installed, FindingState.PROBLEM, f"Needs {pinned}: pip install {name}=={pinned}"
        )
    return Finding(name, installed)


def judge_simulator(old_simulator: str) -> list[Finding]:
    """Return a finding that notebooks import the old `nbev3devsim`, not tuisim's; empty if there is no old one.

    Args:
        old_simulator: The file of the old simulator; empty if notebooks import tuisim's.
    """
    if not old_simulator:
        return []
    advice = "It is tuisim in the kernel RoboLab (tuisim): tuisim kernel install"
    value = f"the old simulator, in {old_simulator}"
    return [Finding("nbev3devsim", value, FindingState.ADVICE, advice)]


Version = tuple[int, ...]


def judge_textual(
    version: Version, tested: tuple[Version, Version], missing: Sequence[str]
) -> Finding:
    """Return a finding on whether the app can draw with the installed Textual.

    Args:
        version: The installed version; empty if it is no release.
        tested: The first and the last version that the app was tested with.
        missing: Names of Textual that the app uses and this version lacks.
    """
    first, last = tested
    installed = ".".join(map(str, version)) or "no release"
    if first <= version <= last and not missing:
        return Finding("Textual", installed)
    lacks = f", and lacks {', '.join(missing)}" if missing else ""
    value = f"{installed}: not a version that the app was tried with{lacks}. It draws half blocks, more slowly"
    requirement = f"textual>={'.'.join(map(str, first))},<={'.'.join(map(str, last))}"
    return Finding(
        "Textual", value, FindingState.ADVICE, f"For the rest: pip install '{requirement}'"
    )


def prevents_use(findings: Iterable[Finding]) -> bool:
    """Return whether any finding prevents the use of tuisim."""
    return any(finding.state is FindingState.PROBLEM for finding in findings)


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
    """Yield the file descriptor of this process's terminal, also if its output is redirected.

    Yield None if there is none, or if this process runs in the background.
    """
    try:
        fd = os.open("/dev/tty", os.O_RDWR | os.O_NOCTTY)
    except OSError:
        yield None
        return
    try:
        # The system would stop a background job that changes its terminal.
        yield fd if os.tcgetpgrp(fd) == os.getpgrp() else None
    finally:
        os.close(fd)


def _restore() -> None:
    # Imported on demand: the report does not need it.
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
            return [judge_no_terminal(), _check_locale(environment)]
        return _ask_terminal(fd, environment, is_remote)


def _ask_terminal(fd: int, environment: Mapping[str, str], is_remote: bool) -> list[Finding]:
    from tuisim.terminal.picture_mode import describe_terminal

    report = describe_terminal(fd, environment)
    if report is None:
        return [judge_no_terminal(), _check_locale(environment)]
    term = environment.get("TERM", "")
    size = os.get_terminal_size(fd)
    return [
        judge_terminal(report.name, term, is_remote=is_remote),
        judge_size(size.columns, size.lines),
        judge_colors(report.colors, is_remote=is_remote, is_fixed=report.has_fixed_colors),
        judge_cells(
            report.cells,
            term if report.is_limited else "",
            _find_locale_variable(report.environment),
        ),
        judge_graphics(report.protocol, has_colors=report.has_colors),
        *([judge_latency(report.latency_s)] if report.is_asked else []),
        _check_locale(environment),
    ]


def _check_locale(environment: Mapping[str, str]) -> Finding:
    return judge_locale(_find_locale_variable(environment), locale.getencoding())


def _find_locale_variable(environment: Mapping[str, str]) -> str:
    """Return the variable that decides the locale with its value; empty if none is set."""
    names = (name for name in ("LC_ALL", "LC_CTYPE", "LANG") if environment.get(name))
    return next((f"{name}={environment[name]}" for name in names), "")


def _check_machine() -> list[Finding]:
    home = home_folder()
    why_not = _explain_unwritable(home)
    findings = [
        judge_system(platform.system(), platform.release()),
        Finding("Python", f"{'.'.join(map(str, sys.version_info[:3]))} ({sys.executable})"),
        home_finding(str(home), why_not),
        judge_assets(_explain_missing_assets()),
    ]
    if not why_not:
        findings.append(store_finding(*_store(home)))
    return [
        *findings,
        _check_textual(),
        *judge_dependencies(_list_requirements()),
        *judge_simulator(str(find_old_simulator() or "")),
    ]


def _check_textual() -> Finding:
    from tuisim.terminal.textual_internals import describe_textual

    return judge_textual(*describe_textual())


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
    """Return the number of stored runs, their size in bytes, and the free space on the disk in bytes."""
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
