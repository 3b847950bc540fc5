"""Runs that were recorded before profiles named their motor law."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.running import Run
from tuisim.core.profile import EARLIER_KEYS, PROFILES
from tuisim.runs.run_folder import StoredRun, read_run

Earlier = Callable[[str], StoredRun]


@pytest.fixture
def earlier(run: Run) -> Earlier:
    """`earlier(profile)`: a stored run as it was written then."""

    def store(profile: str) -> StoredRun:
        folder: Path = run("tank_drive.on_for_seconds(50, 50, 0.1)", profile=profile).run.folder
        file = folder / "run.json"
        data = json.loads(file.read_text())
        data["spec"]["profile"].pop("motor_law", None)
        data["spec"]["profile"] |= dict.fromkeys(EARLIER_KEYS, profile == "nbev3devsim")
        file.write_text(json.dumps(data))
        return read_run(folder)

    return store


@pytest.mark.parametrize(
    ("profile", "notes"),
    [
        (
            "nbev3devsim",
            (
                "recorded with an earlier motor law of the profile nbev3devsim: a rerun may give another result",
            ),
        ),
        ("robolab", ()),
        ("ev3", ()),
    ],
)
def test_an_earlier_run_opens_with_its_motor_law(
    profile: str, notes: tuple[str, ...], earlier: Earlier
) -> None:
    stored = earlier(profile)
    assert stored.spec.profile == PROFILES[profile]
    assert stored.telemetry.count > 1
    assert stored.notes == notes
