"""Every block of code in README and guide is run, every command in their text exists, every link leads somewhere."""

from __future__ import annotations

import re
import shlex
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import click
import pytest

from tests.conftest import ROOT, Command
from tests.guide.documents import (
    DOCUMENTS,
    NARROW_PAGE_COLUMNS,
    Block,
    blocks,
    commands_in_text,
    program,
)
from tuisim.app import app as lab_app
from tuisim.cli import COMMANDS
from tuisim.commands import app as app_command
from tuisim.guide.catalogue import load_pages
from tuisim.guide.markdown import render_markdown
from tuisim.settings.command_line import Group


def _class(where: Path) -> None:
    (where / "class").mkdir()
    program("log_greys.py", where / "class")
    (where / "goals.toml").write_text(
        (ROOT / "programs" / "log_greys_goals.toml").read_text(encoding="utf-8")
    )


PREPARED: dict[str, Callable[[Path], None]] = {
    "marking": _class,
    "experiments": lambda where: program("square.py", where),
    "world-files": lambda where: program("follow_line.py", where),
}
"""What the reader of a page has already."""
RUN_ELSEWHERE = {
    "sh run": ".ci/run",
    "sh test": ".ci/run",
    "sh cluster": "tests/batch/test_cluster.py",
    "python notebook": "tests/notebook/test_lab_responder.py",
    "toml": "tests/engine/test_files.py",
}
"""Where blocks are run that need a fresh environment, several processes, a notebook or the other files of the guide."""
WITH_BLOCKS = [
    name
    for name in DOCUMENTS
    if any(one.kind in ("sh", "sh app", "python") for one in blocks(name))
]


@pytest.fixture
def opened(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """What the app is opened with, in place of the app."""
    found: list[Any] = []

    def run_app(settings: Any) -> int:
        found.append(settings)
        return 0

    monkeypatch.setattr(lab_app, "run_app", run_app)
    monkeypatch.setattr(app_command, "has_terminal", lambda: True)
    return found


@pytest.mark.slow_cases(
    "README",
    "experiments",
    "goal-files",
    "marking",
    "measuring-bands",
    "motion-and-drift",
    "pybricks",
    "python",
)
@pytest.mark.parametrize("name", WITH_BLOCKS)
def test_each_code_block_of_the_guide_runs_and_prints_what_it_says(
    name: str, tmp_path: Path, here: Command, home: Path, opened: list[Any]
) -> None:
    if prepare := PREPARED.get(name):
        prepare(tmp_path)
    names: dict[str, Any] = {}
    for number, block in enumerate(blocks(name)):
        match block.kind:
            case "sh" | "sh app":
                _run_commands(block, here)
            case "python" if block.file:
                (tmp_path / block.file).write_text(block.code)
            case "python":
                # In a file, as a notebook has it: functions keep their source.
                file = tmp_path / f"block_{number}.py"
                file.write_text(block.code)
                exec(compile(block.code, file, "exec"), names)
    assert len(opened) == sum(block.kind == "sh app" for block in blocks(name))


def _run_commands(block: Block, here: Command) -> None:
    for words in block.commands():
        assert words[0] == "tuisim", words
        done = here(*words[1:])
        assert done.returncode == 0, (words, done.stderr)


def test_code_blocks_of_the_guide_not_run_by_this_test_are_run_by_another() -> None:
    kinds = {block.kind for name in DOCUMENTS for block in blocks(name)} - {
        "",
        "sh",
        "sh app",
        "python",
    }
    assert kinds == set(RUN_ELSEWHERE)
    assert [path for path in RUN_ELSEWHERE.values() if not (ROOT / path).exists()] == []


def test_code_blocks_without_a_language_contain_no_command() -> None:
    plain = [block.code for name in DOCUMENTS for block in blocks(name) if block.kind == ""]
    assert ["tuisim" in code.split() for code in plain] == [False] * len(plain)


def test_no_line_of_code_in_the_guide_is_too_long_for_a_narrow_terminal() -> None:
    lines = "\n".join(block.code for name in load_pages() for block in blocks(name)).splitlines()
    drawn = render_markdown("\n".join(["```", *lines, "```"]), NARROW_PAGE_COLUMNS)
    rows = {"".join(text for text, _ in row).strip() for row in drawn}
    assert [line for line in lines if line and line.strip() not in rows] == []


@cache
def _load_commands() -> dict[str, click.Command]:
    """Return every command by its words, without `tuisim`."""
    known = {name: entry.load() for name, entry in COMMANDS.items()}
    for name, command in list(known.items()):
        if isinstance(command, Group):
            known |= {f"{name} {word}": command.load(word) for word in command.listing}
    return known


def _faults(span: str) -> list[str]:
    """What is wrong with a command in a text; words in capitals stand for something."""
    try:
        words = shlex.split(span.replace("…", ""))[1:]
    except ValueError:
        return [span]
    known = _load_commands()
    name = next((found for count in (2, 1) if (found := " ".join(words[:count])) in known), "")
    if (
        not name
        and words
        and re.fullmatch(r"[a-z]+", words[0])
        and not (ROOT / "programs" / f"{words[0]}.py").exists()
    ):
        return [span]
    command = known[name or "open"]
    flags = {
        flag
        for param in command.params
        for flag in (param.opts if isinstance(param, click.Option) else ())
    }
    if isinstance(command, click.Group):
        return []
    ours = words[: words.index("--")] if "--" in words else words
    unknown = [
        word
        for word in ours
        if word.startswith("-") and word != "-" and word not in flags | {"--help", "--version"}
    ]
    return [
        span
        for word in unknown
        if word.startswith("--") or not {f"-{letter}" for letter in word[1:]} <= flags
    ]


def test_each_command_in_the_text_exists() -> None:
    spans = [span for name in DOCUMENTS for span in commands_in_text(name)]
    assert [fault for span in spans for fault in _faults(span)] == []


def test_each_link_leads_to_a_page() -> None:
    for name, text in DOCUMENTS.items():
        links = re.findall(r"\]\(([^)]+)\)", text)
        folder = ROOT if name == "README" else ROOT / "tuisim" / "guide" / "pages"
        assert [link for link in links if "://" not in link and not (folder / link).exists()] == []
        topics = re.findall(r"`tuisim guide ([a-z-]+)`", text)
        assert [topic for topic in topics if topic not in load_pages()] == [], name


def test_no_page_bears_a_commands_name() -> None:
    assert [name for name in load_pages() if name in COMMANDS] == []
