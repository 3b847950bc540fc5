"""The page for man has every command and option, and nothing in it is mistaken for a command of its format."""

from __future__ import annotations

import re

from tests.conftest import Command
from tuisim import __version__
from tuisim.cli import COMMANDS
from tuisim.config.options import OPTIONS

REQUESTS = {".TH", ".SH", ".SS", ".PP", ".TP", ".B", ".br"}


def test_the_page_has_every_command_and_option(here: Command) -> None:
    page = here("man").stdout
    assert page.startswith('.TH TUISIM 1 "" "tuisim ' + __version__)
    sections = set(re.findall(r"^\.SS tuisim (\w+)", page, re.MULTILINE))
    assert set(COMMANDS) <= sections
    plain = page.replace("\\-", "-")
    assert [one.flags[0] for one in OPTIONS if one.flags[0] not in plain] == []
    assert "doctor --reset" in plain


def test_only_its_own_requests_begin_with_a_dot(here: Command) -> None:
    lines = here("man").stdout.split("\n")
    assert {line.split(" ")[0] for line in lines if line.startswith((".", "'"))} <= REQUESTS
