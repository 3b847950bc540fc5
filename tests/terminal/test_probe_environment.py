"""In GNU screen and tmux, what the terminal around them can do counts only if they say so."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Mapping
from pathlib import Path

import pytest

from tests.cases import cases
from tuisim.terminal.probe import name_around, read_colors

AROUND = {"COLORTERM": "truecolor"}
TMUX = {"TMUX": "/run/tmux/default,1,0"}


@pytest.fixture
def tmux(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A tmux that answers what is written to its file, on the search path."""
    answer = tmp_path / "answer"
    answer.write_text("")
    program = tmp_path / "tmux"
    program.write_text(f"#!/bin/sh\ncat {answer}\n")
    program.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=os.pathsep)
    return answer


@cases(
    "environment, features, colors",
    {
        "screen": ({"TERM": "screen"}, "RGB", "256"),
        "screen with 256 colours": ({"TERM": "screen-256color", "STY": "1.pts"}, "RGB", "256"),
        "screen in xterm": ({"TERM": "screen.xterm-256color", "STY": "1.pts"}, "RGB", "256"),
        "screen on the Linux console": ({"TERM": "screen.linux", "STY": "1.pts"}, "", "8"),
        "screen on a terminal without colours": ({"TERM": "screen.vt220"}, "", "none"),
        "tmux that says so": ({"TERM": "screen", **TMUX}, "256,RGB,title", "truecolor"),
        "tmux that does not": ({"TERM": "screen", **TMUX}, "256,title", "256"),
        "tmux that says nothing": ({"TERM": "screen", **TMUX}, "", "256"),
        "screen in tmux": ({"TERM": "screen", "STY": "1.pts", **TMUX}, "RGB", "256"),
        "tmux reduces colours itself": ({"TERM": "tmux-256color", **TMUX}, "256", "auto"),
    },
)
def test_the_number_of_colours_in_screen_or_tmux_follows_its_settings(
    tmux: Path, environment: Mapping[str, str], features: str, colors: str
) -> None:
    tmux.write_text(f"{features}\n")
    assert read_colors({**AROUND, **environment}) == colors


@cases(
    "name, environment, told, around",
    {
        "kitty around tmux": ("tmux 3.5a", TMUX, "kitty(0.42.1)", "kitty(0.42.1)"),
        "unknown": ("tmux 3.5a", TMUX, "", "tmux 3.5a"),
        "over SSH": ("tmux 3.5a", {}, "kitty(0.42.1)", "tmux 3.5a"),
        "screen in tmux": ("tmux 3.5a", {"STY": "1.pts", **TMUX}, "kitty(0.42.1)", "tmux 3.5a"),
        "no tmux": ("foot(1.22.0)", TMUX, "kitty(0.42.1)", "foot(1.22.0)"),
    },
)
def test_the_name_of_the_terminal_around_tmux_is_found(
    tmux: Path, name: str, environment: Mapping[str, str], told: str, around: str
) -> None:
    tmux.write_text(f"{told}\n")
    assert name_around(name, environment) == around


def test_a_tmux_that_is_not_there_or_does_not_answer_means_256_colours(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    environment = {**AROUND, "TERM": "screen", **TMUX}
    monkeypatch.setenv("PATH", str(tmp_path))
    assert read_colors(environment) == "256"

    def never(command: list[str], **_: object) -> None:
        raise subprocess.TimeoutExpired(command, 1.0)

    monkeypatch.setattr(subprocess, "run", never)
    assert read_colors(environment) == "256"
