"""Judgements of the terminal and the machine: whether each property is good for tuisim, and if not, what to do.

Pure: `doctor` looks at the machine, and these functions judge what it found.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from enum import StrEnum

from tuisim.base.data_class import dataclass
from tuisim.terminal.picture_options import CellSet

SMALLEST = (60, 18)
COMFORTABLE = (80, 24)
"""Columns and rows that the app needs, and the columns and rows for which it is designed."""
SLOW_S = 0.15
"""A user notices if the terminal takes longer to answer."""
LARGE_STORE_MB = 2000
OLDEST_PYTHON = (3, 11)


class FindingState(StrEnum):
    """Whether what was found is good, could be better, or prevents the use of tuisim."""

    OK = "ok"
    ADVICE = "advice"
    """Usable; something could be better."""
    PROBLEM = "problem"
    """tuisim cannot be used until it is solved."""


@dataclass(frozen=True, slots=True)
class Finding:
    """One line of the report."""

    name: str
    value: str
    state: FindingState = FindingState.OK
    advice: str = ""
    """What to do about it."""


def judge_terminal(name: str, term: str, *, is_remote: bool) -> Finding:
    """Judge which terminal this is.

    Args:
        name: What the terminal calls itself; empty if it does not tell.
        term: The variable TERM.
        is_remote: Whether the terminal is reached by SSH.
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
    """Judge that there is no terminal."""
    advice = "The app needs a terminal; `tuisim run`, `batch`, `log` and notebooks do not"
    return Finding("terminal", "none", FindingState.ADVICE, advice)


def judge_colors(depth: str, *, is_remote: bool, is_fixed: bool = False) -> Finding:
    """Judge the number of colours.

    Args:
        depth: What the app would draw with: one of `COLOR_DEPTHS` other than `auto`.
        is_remote: Whether the terminal is reached by SSH.
        is_fixed: Whether TERM or NO_COLOR decides, so that COLORTERM changes nothing.
    """
    if depth == "truecolor":
        return Finding("colours", "truecolor (16 million)")
    value = {"none": "none", "8": "8", "16": "16", "256": "256"}[depth]
    if is_fixed:
        return Finding(
            "colours",
            f"{value}, as TERM or NO_COLOR says",
            FindingState.ADVICE,
            "--colors chooses another number",
        )
    sent = "; SSH does not send this variable by itself" if is_remote else ""
    advice = f"If the terminal shows more, as most do: export COLORTERM=truecolor{sent}"
    return Finding("colours", value, FindingState.ADVICE, advice)


_POINTS = {
    CellSet.HALF: "1 × 2 points in a cell",
    CellSet.QUADRANT: "2 × 2 points in a cell",
    CellSet.SEXTANT: "2 × 3 points in a cell",
    CellSet.OCTANT: "2 × 4 points in a cell",
    CellSet.BRAILLE: "2 × 4 dots in a cell",
    CellSet.ASCII: "letters and signs",
}


def judge_cells(cells: CellSet, term: str = "", variable: str = "") -> Finding:
    """Judge the finest glyphs that the terminal is known to show.

    Args:
        cells: The glyphs.
        term: The variable TERM if it is the reason for no finer glyphs, else empty.
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
    """Judge by which protocol the terminal shows pixels.

    Args:
        protocol: Its name; empty if there is none.
        has_colors: Whether colours are allowed; without colours, there are no pixels.
    """
    why = "" if has_colors else ", as TERM or NO_COLOR says"
    return Finding("graphics", protocol or f"none{why}: the world is drawn with glyphs")


def judge_size(cols: int, rows: int) -> Finding:
    """Judge the size of the terminal in cells."""
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
    """Judge the locale.

    Args:
        variable: The variable that decides it with its value, such as `LANG=C.UTF-8`; empty if none is set.
        encoding: The encoding that Python uses.
    """
    value = f"{variable or 'not set'} ({encoding})"
    if encoding.lower().replace("-", "") != "utf8" or (variable and "utf" not in variable.lower()):
        return Finding("locale", value, FindingState.ADVICE, f"Use UTF-8: {_use_utf8(variable)}")
    return Finding("locale", value)


def _use_utf8(variable: str) -> str:
    """Return the shell command for UTF-8: it sets the variable that decides the locale, as LC_ALL hides the others."""
    return f"export {variable.partition('=')[0] or 'LANG'}=C.UTF-8"


def judge_latency(latency_s: float | None) -> Finding:
    """Judge how long the terminal takes to answer; `latency_s` is None if it does not answer."""
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


def judge_python(version: tuple[int, ...], path: str) -> Finding:
    """Judge the version of Python."""
    value = f"{'.'.join(map(str, version))} ({path})"
    if version < OLDEST_PYTHON:
        return Finding(
            "Python", value, FindingState.PROBLEM, "Install tuisim with Python 3.11 or later"
        )
    return Finding("Python", value)


def judge_system(system: str, release: str) -> Finding:
    """Judge the operating system, such as Linux."""
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
    """Judge the folder of runs, drafts and preferences.

    Args:
        folder: Its path.
        why_not: Why it cannot be written; empty if it can.
    """
    if why_not:
        advice = "Runs cannot be stored: fix the permissions, or export TUISIM_HOME=FOLDER"
        return Finding("home folder", f"{folder}: {why_not}", FindingState.PROBLEM, advice)
    return Finding("home folder", f"{folder} (writable)")


def store_finding(count: int, size_bytes: int, free_bytes: int) -> Finding:
    """Judge the stored runs: their number, their size and what is left on the disk."""
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
    """Judge whether the mats and the examples are there; `why_not` is empty if they are."""
    if why_not:
        return Finding(
            "mats", why_not, FindingState.PROBLEM, "Install tuisim again, or fix TUISIM_ASSETS"
        )
    return Finding("mats", "found")


def judge_dependencies(requirements: Iterable[tuple[str, str, str]]) -> list[Finding]:
    """Judge the packages that tuisim needs: one finding for those that are all right, one for each other.

    Args:
        requirements: For each its name, the version that is required exactly or an empty text, and the installed
            version or an empty text.
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
    """Return a finding if the notebooks of a course import the old `nbev3devsim` and not tuisim's.

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
    """Judge how the app can draw with the installed Textual.

    Args:
        version: The installed version; empty if it is no release.
        tested: The first and the last version that the app was tried with.
        missing: Names of Textual's that the app uses, and that this version lacks.
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
