"""In GNU screen and tmux, what the terminal around them can do counts only if they say so."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Mapping
from pathlib import Path

import pytest

from tuisim.terminal.probe import colors_without_asking, name_around

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


@pytest.mark.parametrize(
    ("environment", "features", "colors"),
    [
        pytest.param({"TERM": "screen"}, "RGB", "256", id="screen"),
        pytest.param(
            {"TERM": "screen-256color", "STY": "1.pts"}, "RGB", "256", id="screen with 256 colours"
        ),
        pytest.param(
            {"TERM": "screen.xterm-256color", "STY": "1.pts"}, "RGB", "256", id="screen in xterm"
        ),
        pytest.param(
            {"TERM": "screen.linux", "STY": "1.pts"}, "", "8", id="screen on the Linux console"
        ),
        pytest.param(
            {"TERM": "screen.vt220"}, "", "none", id="screen on a terminal without colours"
        ),
        pytest.param(
            {"TERM": "screen", **TMUX}, "256,RGB,title", "truecolor", id="tmux that says so"
        ),
        pytest.param({"TERM": "screen", **TMUX}, "256,title", "256", id="tmux that does not"),
        pytest.param({"TERM": "screen", **TMUX}, "", "256", id="tmux that says nothing"),
        pytest.param({"TERM": "screen", "STY": "1.pts", **TMUX}, "RGB", "256", id="screen in tmux"),
        pytest.param(
            {"TERM": "tmux-256color", **TMUX}, "256", "auto", id="tmux reduces colours itself"
        ),
    ],
)
def test_the_colours_in_a_multiplexer(
    tmux: Path, environment: Mapping[str, str], features: str, colors: str
) -> None:
    tmux.write_text(f"{features}\n")
    assert colors_without_asking({**AROUND, **environment}) == colors


@pytest.mark.parametrize(
    ("name", "environment", "told", "around"),
    [
        pytest.param("tmux 3.5a", TMUX, "kitty(0.42.1)", "kitty(0.42.1)", id="kitty around tmux"),
        pytest.param("tmux 3.5a", TMUX, "", "tmux 3.5a", id="unknown"),
        pytest.param("tmux 3.5a", {}, "kitty(0.42.1)", "tmux 3.5a", id="over SSH"),
        pytest.param(
            "tmux 3.5a", {"STY": "1.pts", **TMUX}, "kitty(0.42.1)", "tmux 3.5a", id="screen in tmux"
        ),
        pytest.param("foot(1.22.0)", TMUX, "kitty(0.42.1)", "foot(1.22.0)", id="no tmux"),
    ],
)
def test_the_terminal_around_tmux(
    tmux: Path, name: str, environment: Mapping[str, str], told: str, around: str
) -> None:
    tmux.write_text(f"{told}\n")
    assert name_around(name, environment) == around


def test_a_tmux_that_is_not_there_or_does_not_answer_means_256_colours(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    environment = {**AROUND, "TERM": "screen", **TMUX}
    monkeypatch.setenv("PATH", str(tmp_path))
    assert colors_without_asking(environment) == "256"

    def never(command: list[str], **_: object) -> None:
        raise subprocess.TimeoutExpired(command, 1.0)

    monkeypatch.setattr(subprocess, "run", never)
    assert colors_without_asking(environment) == "256"
