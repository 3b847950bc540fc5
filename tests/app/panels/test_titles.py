"""The titles of panels: key, name, and what is named once."""

from __future__ import annotations

from dataclasses import replace

import pytest
from textual.app import App
from textual.content import Content

from tests.app.app_help import program
from tests.app.panel_help import SPEC, moment
from tuisim.app.panels.titles import build_title, name_mat, name_sensors, name_setup
from tuisim.engine.core.tree import put


def test_a_title_has_the_key_of_its_panel_and_shows_a_name_as_it_is() -> None:
    app: App[None] = App()
    assert Content.from_markup(build_title(app, "chart")).plain == "c Chart"
    title = build_title(app, "output", "a[b].py")
    assert Content.from_markup(title).plain == "O Output: a[b].py"


@pytest.mark.parametrize(
    "width, words",
    [
        (80, "Sensor1 · left · in2 · colorLeft │ Sensor2 · right · in3 · colorRight"),
        (65, "Sensor1 left in2 colorLeft │ Sensor2 right in3 colorRight"),
        (40, "Sensor1 left in2 │ Sensor2 right in3"),
        (30, ""),
    ],
)
def test_a_title_names_sensors_as_fully_as_there_is_room(width: int, words: str) -> None:
    assert name_sensors(moment(program=program("pass")), width) == words


def test_a_title_names_no_predefined_sensor_name_if_the_program_has_none() -> None:
    plain = replace(program("pass"), prelude="none")
    assert name_sensors(moment(program=plain), 80) == "Sensor1 · left · in2 │ Sensor2 · right · in3"


def test_a_title_names_noise_seed_and_drift_only_where_there_are_any() -> None:
    assert name_setup(moment(), 60) == "Default_Robot"
    assert name_setup(moment(), 20) == ""
    drifting = put(SPEC, "world.drift.gyro_dps", 1.0)
    assert name_setup(moment(spec=drifting), 60) == "Default_Robot, drift"


@pytest.mark.parametrize(
    "width, words", [(60, "Grey_bands · F8 analyse"), (26, "F8 analyse"), (16, "Grey_bands")]
)
def test_the_layout_is_named_beside_the_mat_or_in_its_place(width: int, words: str) -> None:
    assert name_mat("Grey_bands", "F8 analyse", width) == words
