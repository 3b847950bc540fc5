"""README names what there is: every command, switch, key and format, and where each kind of thing is added."""

from __future__ import annotations

import re

import pytest

from tests.conftest import ROOT
from tuisim.cli import COMMANDS
from tuisim.commands.log import SUBCOMMANDS
from tuisim.core.profile import PROFILES
from tuisim.core.spec import MOUNTS
from tuisim.datalog.formats import EXPORTERS
from tuisim.switches import SWITCHES
from tuisim.ui.actions import ACTIONS
from tuisim.ui.analyser.actions import ACTIONS as ANALYSER_ACTIONS
from tuisim.ui.panels import PANELS

README = (ROOT / "README.md").read_text(encoding="utf-8")
HOW_TO_ADD = README.partition("| to add | do |")[2].partition("\n\n")[0].splitlines()[2:]
QUOTED = set(re.findall(r"`([^`\n]+)`", README))
"""Everything in backticks."""
WORDS = {word for quoted in QUOTED for word in re.split(r"[ |,/…\\]+", quoted) if word}
TABLES = {
    "command": COMMANDS,
    "subcommand of log": SUBCOMMANDS,
    "profile": PROFILES,
    "export format": EXPORTERS,
    "switch": [switch.flags[0] for switch in SWITCHES],
    "panel's key": [panel.key for panel in PANELS.values()],
    "app's key": [action.key_label for action in ACTIONS.values() if not action.id.startswith("nudge-")],
    "analyser's key": [action.label for action in ANALYSER_ACTIONS.values()],
}


def told(name: str) -> bool:
    """Whether a name stands in backticks; a key of several letters may also stand in a list of them."""
    return name in QUOTED | WORDS or (len(name) > 1 and re.search(rf"[ |]{re.escape(name)}[ ,|]", README) is not None)


@pytest.mark.parametrize("what", TABLES)
def test_everything_in_a_table_is_told(what: str) -> None:
    assert [name for name in TABLES[what] if not told(name)] == []


def test_every_sensor_of_a_robots_file_is_told() -> None:
    found = {mount.key: re.search(rf"^{mount.key} =|\[{mount.key}[.\]]", README, re.MULTILINE) for mount in MOUNTS}
    assert [key for key, place in found.items() if place is None] == []


def test_where_things_are_added_is_there() -> None:
    sources = [*(ROOT / "tuisim").rglob("*.py"), *(ROOT / "backgrounds").glob("*.py")]
    code = "\n".join(path.read_text(encoding="utf-8") for path in sources)
    assert len(HOW_TO_ADD) > 8
    for row in HOW_TO_ADD:
        for word in re.findall(r"`([\w/.]+)`", row):
            if "/" in word or "." in word:
                assert (ROOT / "tuisim" / word).exists() or (ROOT / word).exists(), word
            else:
                assert re.search(rf"^(class )?{word}\b", code, flags=re.MULTILINE), word
