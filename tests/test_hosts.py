"""An enemy among other programs falsifies its own run, in every host; the others run as without it."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.hosts import HOSTS, hosted
from tests.tasks.marks.attackers import TO_ALL

OTHER = "tank_drive.on_for_rotations(50, 50, 1)\nprint('A: 1')"
PROGRAMS = {"ada": f"{OTHER}  # ada", "eve": f"{TO_ALL}print('B: 1')", "zoe": f"{OTHER}  # zoe"}
SLOW = ("app", "notebook")
CODES = {"run": 1, "batch": 1}
"""Exit codes of the commands that tell how programs end."""


@pytest.mark.parametrize(
    "host", [pytest.param(host, marks=[pytest.mark.slow] * (host in SLOW)) for host in HOSTS]
)
def test_a_hostile_program_affects_only_its_own_run(host: str, tmp_path: Path) -> None:
    found = hosted(host, PROGRAMS, tmp_path / "place")
    assert [found.runs[name].end for name in PROGRAMS] == ["finished", "falsified", "finished"]
    assert found.runs["ada"] == found.runs["zoe"]
    assert found.runs["ada"].printed == ("A: 1",)
    assert found.code == CODES.get(host, 0)
