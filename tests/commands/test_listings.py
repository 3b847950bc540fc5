"""Lists of mats, robots, obstacles, programs and profiles."""

from __future__ import annotations

import json

import pytest

from tests.conftest import Command


@pytest.mark.parametrize(
    "command, name",
    [
        ("backgrounds", "Grey_bands"),
        ("robots", "Small_Robot"),
        ("obstacles", "Square_posts"),
        ("programs", "log_greys.py"),
        ("profiles", "robolab"),
    ],
)
def test_lists(command: str, name: str, here: Command) -> None:
    assert name in here(command).stdout
    assert name in [entry["name"] for entry in json.loads(here(command, "--json").stdout)]


def test_list_of_robots_tells_their_ports(here: Command) -> None:
    assert "in1 bumper, in2 left, in3 infrared" in here("robots").stdout
