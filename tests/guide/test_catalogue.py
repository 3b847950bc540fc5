"""The pages: contents, tables from the code, HTML, and the command that shows them."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.app.terminals import Terminal
from tests.cases import cases, for_each
from tests.conftest import ROOT, Command
from tuisim.app.actions.keys import ACTIONS
from tuisim.cli import COMMANDS
from tuisim.engine.core.profile import PROFILES
from tuisim.engine.runs.frames import SAMPLE_COLUMNS
from tuisim.guide.catalogue import GuidePart, load_pages
from tuisim.guide.tables import TABLES, load_table
from tuisim.settings.options import OPTIONS
from tuisim.settings.user_config import SETTINGS

WORDS_OF = {
    "keys": [action.key_label for action in ACTIONS.values()],
    "commands": [f"tuisim {name}" for name in COMMANDS],
    "settings": [one.name for one in SETTINGS.values()],
    "options": [flag for option in OPTIONS for flag in option.flags],
    "profile-rules": list(PROFILES),
    "samples": list(SAMPLE_COLUMNS),
    "breakpoints": ["stall", "time 3.5"],
}
"""What a table must say."""


def test_every_file_is_a_page_of_the_contents() -> None:
    files = {path.stem for path in (ROOT / "tuisim" / "guide" / "pages").iterdir()}
    assert files == set(load_pages())
    assert {page.part for page in load_pages().values()} == set(GuidePart)


def test_every_generated_table_is_used_in_a_page_of_the_guide() -> None:
    marks = re.compile(r"<!-- table: ([\w-]+) -->")
    assert {name for page in load_pages().values() for name in marks.findall(page.source)} == set(
        TABLES
    )


@for_each(name=TABLES)
def test_every_row_of_a_guides_table_has_a_cell_for_each_column(name: str) -> None:
    made = load_table(name)
    assert made.rows
    assert {len(row) for row in made.rows} == {len(made.columns)}


@pytest.mark.parametrize("name", WORDS_OF)
def test_each_generated_table_of_the_guide_equals_what_the_code_says(name: str) -> None:
    text = load_table(name).to_markdown()
    missing = [
        word
        for word in WORDS_OF[name]
        if not re.search(rf"`{re.escape(word).replace('|', '.+')}[` ]", text)
    ]
    assert missing == []


@cases(
    "words, topic",
    {
        "a breakpoint": (["run", "log_greys", "--break", "wen hot"], "breakpoints"),
        "a magic line": (["run", "magic.py"], "writing-programs"),
        "goals": (["goals", "check", "empty.toml"], "goal-files"),
        "a parameter": (["batch", "log_greys", "--set", "noise"], "experiments"),
        "a class": (["mark", str(ROOT / "programs" / "log_greys_goals.toml"), "nobody"], "marking"),
    },
)
def test_an_error_names_the_page_of_the_guide_that_helps(
    words: list[str], topic: str, tmp_path: Path, here: Command
) -> None:
    (tmp_path / "magic.py").write_text("# %%sim_magic_preload\nprint(1)\n")
    (tmp_path / "empty.toml").write_text('title = "none"\n')
    (tmp_path / "nobody").mkdir()
    done = here(*words)
    assert (done.returncode, f"see `tuisim guide {topic}`" in done.stderr) == (2, True), done.stderr


def test_the_pages_that_errors_name_exist() -> None:
    sources = "".join(path.read_text(encoding="utf-8") for path in (ROOT / "tuisim").rglob("*.py"))
    named = set(re.findall(r"see_page\(['\"]([\w-]+)", sources)) | set(
        re.findall(r"`tuisim guide ([a-z-]+)`", sources)
    )
    assert len(named) > 4
    assert named <= set(load_pages())


@pytest.mark.parametrize("name", load_pages())
def test_the_shell_prints_a_page(name: str, here: Command) -> None:
    done = here("guide", name)
    assert (done.returncode, done.stderr) == (0, "")
    assert load_pages()[name].title in done.stdout.splitlines()[0]
    assert "\x1b" not in done.stdout
    assert max(map(len, done.stdout.splitlines())) <= 100


def test_the_shell_lists_the_contents_and_searches(here: Command) -> None:
    listed = here("guide").stdout
    assert [name for name in load_pages() if name not in listed] == []
    assert here("guide", "--search", "wheel diameter").stdout.split()[1] == "world-files"


@cases(
    "words, code, said",
    {
        "no page": (
            ["keyz"],
            2,
            "guide: no such page 'keyz' (did you mean keys?)",
        ),
        "two at once": (["keys", "--search", "x"], 2, "cannot be combined"),
        "HTML": (["--html", "a"], 2, "no such option: --html (`tuisim guide` and the key ?"),
        "nothing found": (["--search", "xyzzy"], 1, "No page has these words: xyzzy"),
    },
)
def test_a_page_that_cannot_be_shown_says_why(
    words: list[str], code: int, said: str, tmp_path: Path, here: Command
) -> None:
    (tmp_path / "a_file").write_text("")
    done = here("guide", *words)
    assert done.returncode == code
    assert said in done.stderr + done.stdout


@pytest.mark.tmux
@pytest.mark.slow
def test_tuisim_guide_in_a_terminal_shows_the_page_in_a_pager(tmp_path: Path) -> None:
    terminal = Terminal(f"guide{tmp_path.name}", tmp_path)
    terminal.start(["guide", "breakpoints"], 80, 24)
    try:
        first = terminal.until(lambda screen: "Breakpoints" in screen and "pauses when" in screen)
        assert ("EXIT" in first, "[1m" in first) == (False, False)
        terminal.keys("q")
        terminal.until(lambda screen: "EXIT 0" in screen)
    finally:
        terminal.end()


@pytest.mark.tmux
@pytest.mark.slow
def test_a_search_that_fits_the_screen_opens_no_pager(tmp_path: Path) -> None:
    terminal = Terminal(f"guide{tmp_path.name}", tmp_path)
    terminal.start(["guide", "--search", "black outside the mat"], 80, 24)
    try:
        terminal.until(lambda screen: "How the sensors see" in screen and "EXIT 0" in screen)
    finally:
        terminal.end()
