"""The tables of hubs on the page Pybricks say what a program finds on each hub, and what it is refused."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.conftest import Command
from tuisim.engine.core.hub_spec import HUBS
from tuisim.engine.shim.pybricks.unsimulated import HUB_CLASSES as REFUSED
from tuisim.guide.catalogue import load_pages

LINES = load_pages()["pybricks"].source.splitlines()
ROWS = {
    hub: [re.findall(r"`(\w+(?:-\w+)?)`", cell) for cell in line.split("|")[2:-1]]
    for line in LINES
    if re.match(r"\| `\w+(Hub|Brick)`", line)
    for hub in re.findall(r"`(\w+(?:Hub|Brick))`", line)
}
"""The cells of each hub: ports, usual motor, parts, what is refused."""
PARTS = sorted({part for _, _, *cells in ROWS.values() for cell in cells for part in cell})
PROGRAM = """\
from pybricks.hubs import {hub} as Hub
from pybricks import parameters, tools
hub = Hub()
print("parts:", *[part for part in {parts} if hasattr(hub, part)])
print("matrix:", "Icon" in vars(parameters), "hub_menu" in vars(tools))
for part in {refused}:
    try:
        getattr(hub, part).observe(1)
    except Exception as error:
        print(type(error).__name__, part)
"""
USE = """\
from importlib import import_module
import pybricks.hubs
from pybricks.hubs import PrimeHub
for module, classes in {refused}.items():
    for name in classes:
        try:
            getattr(import_module(module), name)()
        except Exception as error:
            print(type(error).__name__, name)
"""


def test_the_guides_table_of_hubs_has_each_hubs_ports_and_motor() -> None:
    assert set(ROWS) == {*HUBS, "EV3Brick"}
    for hub, kind in HUBS.items():
        (first, last), motors, *_ = ROWS[hub]
        assert ("".join(kind.ports[:1]), kind.ports[-1]) == (first, last), hub
        assert motors == [kind.motor], hub


@pytest.mark.quick_cases("PrimeHub", "CityHub")
@pytest.mark.parametrize("hub", ROWS)
def test_each_hub_has_exactly_the_parts_in_the_guides_table(
    hub: str, here: Command, tmp_path: Path
) -> None:
    _, _, parts, refused = ROWS[hub]
    (tmp_path / "parts.py").write_text(PROGRAM.format(hub=hub, parts=PARTS, refused=refused))
    done = here("run", "parts.py", "--profile", "pybricks4")
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines() == [
        " ".join(["parts:", *sorted([*parts, *refused])]),
        f"matrix: {'display' in parts} {'display' in parts}",
        *(f"NotSimulated {part}" for part in refused),
    ]


def test_the_guides_page_on_hubs_names_each_class_that_is_refused() -> None:
    start = LINES.index("| module | not simulated on a hub |") + 2
    rows = [line.split("|")[1:3] for line in LINES[start : start + len(REFUSED)]]
    assert {module.strip(" `"): re.findall(r"`(\w+)`", cell) for module, cell in rows} == {
        module: [*names] for module, names in REFUSED.items()
    }


def test_a_program_that_uses_a_refused_class_is_told_so(here: Command, tmp_path: Path) -> None:
    classes = {module: [*names] for module, names in REFUSED.items()}
    (tmp_path / "use.py").write_text(USE.format(refused=classes))
    assert here("run", "use.py").stdout.splitlines() == [
        f"NotSimulated {name}" for names in REFUSED.values() for name in names
    ]
