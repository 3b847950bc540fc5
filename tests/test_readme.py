"""README and guide name what there is: every command, switch, key and format, and where each thing is added."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest

from tests.cases import for_each
from tests.conftest import ROOT, Command
from tuisim.app.action import label_of_key
from tuisim.app.actions.keys import ACTIONS
from tuisim.app.analyser.actions.keys import ACTIONS as ANALYSER_ACTIONS
from tuisim.app.panels import PANELS
from tuisim.cli import COMMANDS
from tuisim.commands.log import SUBCOMMANDS
from tuisim.engine.core.profile import PROFILES
from tuisim.engine.core.spec import MOUNTS
from tuisim.guide.catalogue import load_pages
from tuisim.guide.tables import build_markdown
from tuisim.logs.export import EXPORTERS
from tuisim.settings.options import OPTIONS

README = (ROOT / "README.md").read_text(encoding="utf-8")
GUIDE = "\n\n".join(build_markdown(page).replace("\\|", "|") for page in load_pages().values())
HOW_TO_ADD = GUIDE.partition("| to add | you need |")[2].partition("\n\n")[0].splitlines()[2:]
QUOTED = set(re.findall(r"`([^`\n]+)`", GUIDE))
"""Everything in backticks."""
WORDS = {word for quoted in QUOTED for word in re.split(r"[ |,/…\\]+", quoted) if word}
TABLES = {
    "command": COMMANDS,
    "subcommand of log": SUBCOMMANDS,
    "profile": PROFILES,
    "export format": EXPORTERS,
    "option": [option.flags[0] for option in OPTIONS],
    "panel's key": [label_of_key(panel.key) for panel in PANELS.values()],
    "app's key": [
        action.key_label for action in ACTIONS.values() if not action.id.startswith("nudge-")
    ],
    "analyser's key": [action.key_label for action in ANALYSER_ACTIONS.values()],
}


def is_documented(name: str) -> bool:
    """Whether a name is in backticks; a key of several letters may also be in a list of keys."""
    return name in QUOTED | WORDS or (
        len(name) > 1 and re.search(rf"[ |]{re.escape(name)}[ ,|]", GUIDE) is not None
    )


@for_each(what=TABLES)
def test_every_command_option_profile_and_key_is_documented(what: str) -> None:
    assert [name for name in TABLES[what] if not is_documented(name)] == []


def test_no_commands_help_has_a_raises_section() -> None:
    helps = {name: entry.load().help or "" for name, entry in COMMANDS.items()}
    assert [name for name, text in helps.items() if "Raises:" in text] == []


def test_every_sensor_of_a_robot_file_is_documented() -> None:
    found = {
        mount.key: re.search(rf"^{mount.key} =|\[{mount.key}[.\]]", GUIDE, re.MULTILINE)
        for mount in MOUNTS
    }
    assert [key for key, place in found.items() if place is None] == []


def test_places_named_in_the_docs_for_adding_things_exist() -> None:
    sources = [*(ROOT / "tuisim").rglob("*.py"), *(ROOT / "backgrounds").glob("*.py")]
    code = "\n".join(path.read_text(encoding="utf-8") for path in sources)
    assert len(HOW_TO_ADD) > 8
    for row in HOW_TO_ADD:
        for word in re.findall(r"`([\w/.]+)`", row):
            if "/" in word or "." in word:
                assert (ROOT / "tuisim" / word).exists() or (ROOT / word).exists(), word
            else:
                assert re.search(rf"^(class |def )?{word}\b", code, flags=re.MULTILINE), word


def block(language: str, holding: str) -> str:
    """The one block of code in a language that holds a text."""
    (found,) = [
        code
        for code in re.findall(rf"```{language}\n(.*?)```", GUIDE, re.DOTALL)
        if holding in code
    ]
    return str(found)


@pytest.mark.slow
def test_the_readmes_first_program_runs_also_with_the_readmes_robot_file(
    tmp_path: Path, here: Command
) -> None:
    (tmp_path / "my_program.py").write_text(
        block("python", "tank_drive.on(SpeedPercent(50), SpeedPercent(50))")
    )
    (tmp_path / "robot.toml").write_text(block("toml", "# robot.toml"))
    for robot in ("Default_Robot", "robot.toml"):
        done = here("run", "my_program.py", "-r", robot)
        assert (done.returncode, done.stdout.splitlines()[0]) == (0, "Colour: 100.0"), done.stderr


def test_the_readmes_code_for_reading_logs_and_runs_works(tmp_path: Path, here: Command) -> None:
    assert (
        here("run", "log_greys", "--export", "greys.csv", "--export", "greys.jsonl").returncode == 0
    )
    names: dict[str, Any] = {}
    exec(block("python", 'read_log("greys'), names)
    assert names["df"]["variable"].unique().tolist() == ["Colour"]
    ends = [line for line in block("python", "load_run(").splitlines() if "load_run(" in line]
    for expression in re.findall(r"run(?:\.\w+)+", ends[0].partition("#")[2]):
        assert eval(expression, names) is not None, expression
    beside = {path.name for path in tmp_path.glob("greys.*.json")}
    assert beside == {"greys.csv.json", "greys.jsonl.json"}
    assert all(name.replace("greys", "NAME") in QUOTED for name in beside)
