"""The guide's page of licences lists every package that an install brings."""

from __future__ import annotations

import re
import tomllib

from tests.conftest import ROOT

TABLE = dict(
    re.findall(
        r"^\| ([a-z0-9-]+) \| (.*?) \|$",
        (ROOT / "tuisim/guide/pages/licences.md").read_text(),
        re.MULTILINE,
    )[1:]
)


def test_every_dependency_is_listed_with_its_licence() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    names = {re.split(r"[<>=!~\[; ]", line)[0] for line in project["dependencies"]}
    assert names - {name for name, licence in TABLE.items() if licence} == set()
