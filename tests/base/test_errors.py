"""Names in logs are shown, never obeyed by the terminal."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest

from tests.cases import cases
from tuisim.base.errors import MOST_LISTED, listed, nearest, printable
from tuisim.cli import run_command

EVIL = "a\x1b[31m\x9bb\x07"
SHOWN = "a\ufffd[31m\ufffdb\ufffd"


@pytest.fixture
def log(tmp_path: Path) -> str:
    """A log that needs a note, of a variable with an evil name."""
    path = tmp_path / f"{EVIL}.jsonl"
    path.write_text(
        "\n".join(json.dumps({"time": at, EVIL: at}) for at in range(9)) + "\nno object\n"
    )
    return str(path)


CALLS = {
    "a table": ("summary",),
    "a sentence": ("bands",),
    "an error": ("summary", "--variable", "zz"),
    "a chart": ("plot", "--size", "60x20"),
    "rows": ("derive",),
}


@cases("words", CALLS)
def test_control_characters_in_names_do_not_reach_the_terminal(
    log: str,
    words: tuple[str, ...],
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True)
    monkeypatch.setenv("NO_COLOR", "1")
    run_command(["log", words[0], log, *words[1:]])
    said = "".join(capsys.readouterr())
    assert SHOWN in said
    # The chart's title is bold.
    assert not [part for part in ("\x1b[31m", "\x9b", "\x07") if part in said]


def test_rows_piped_to_a_program_keep_control_characters(
    log: str, capsys: pytest.CaptureFixture[str]
) -> None:
    run_command(["log", "derive", log])
    assert EVIL in capsys.readouterr().out


@pytest.mark.parametrize(
    "text, shown",
    [("Größe 😀", "Größe 😀"), ("a\tb\nc", "a b c"), ("\ud800\u202e", "\ufffd\ufffd")],
    ids=["letters", "white space", "no letters"],
)
def test_printable_replaces_control_characters(text: str, shown: str) -> None:
    assert printable(text) == shown


def test_an_error_lists_only_some_of_many_names() -> None:
    assert listed(iter("ab")) == "a, b"
    assert listed(()) == "none"
    assert listed(map(str, range(10_000))).endswith(
        f", {MOST_LISTED - 1} and {10_000 - MOST_LISTED} more"
    )


PROGRAM = f"""# %%sim_magic_preloaded
# {EVIL}
tank_drive.on_for_seconds(20, 30, 0.1)
print('{EVIL}')
say('{EVIL}')
raise ValueError('{EVIL}')
"""


@pytest.fixture(scope="module")
def stored(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A program that raises, in a home with two stored runs of it that differ; all that is text in them is evil."""
    folder = tmp_path_factory.mktemp("stored")
    program = folder / f"{EVIL}.py"
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("TUISIM_HOME", str(folder))
        for more in ("", f"# {EVIL}"):
            program.write_text(PROGRAM + more)
            run_command(["run", str(program)])
    return program


STORED_CALLS = {
    "the state of a run": ("runs", "show", "last"),
    "the list of runs": ("runs",),
    "where runs differ": ("log", "diff", "1", "2"),
    "a re-run": ("runs", "rerun", "1"),
    "a run that is not there": ("runs", "show", EVIL),
    "a report": ("log", "report", "last"),
    "a run": ("run", "PROGRAM", "--break", "5", "--watch", repr(EVIL)),
    "runs as JSON": ("runs", "show", "1", "--json"),
}


@pytest.mark.slow
@cases("words", STORED_CALLS)
def test_stored_text_is_shown_without_control_characters(
    stored: Path,
    words: tuple[str, ...],
    capfd: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(stored.parent)
    monkeypatch.setenv("TUISIM_HOME", str(stored.parent))
    run_command([str(stored) if word == "PROGRAM" else word for word in words])
    said = "".join(capfd.readouterr()).splitlines()
    # What the program printed and its traceback are passed on as a shell would.
    raised = ("  File ", "    raise ", "ValueError: ") if words[0] == "run" else ()
    own = [line for line in said if line != EVIL and not line.startswith(raised)]
    assert own
    assert not [line for line in own if not line.isprintable()]


def test_a_name_that_is_only_half_like_a_wrong_one_is_not_suggested() -> None:
    assert nearest("nope", ["Loop", "Square"]) == "one of Loop, Square"
    assert nearest("Sqare", ["Loop", "Square"]) == "did you mean Square?"
