"""Each constant of the motors is told with its source."""

from __future__ import annotations

from dataclasses import fields

from tuisim.engine.core.driver.figures import PLANT_SOURCES, list_figures
from tuisim.engine.core.driver.plant import LARGE, MEDIUM, PlantSpec


def test_every_constant_of_a_motor_has_a_source() -> None:
    names = [field.name for field in fields(PlantSpec)]
    assert list(PLANT_SOURCES) == names
    figures = {figure.name: figure for figure in list_figures()}
    for name in names:
        figure = figures[name]
        assert (figure.large, figure.medium) == (getattr(LARGE, name), getattr(MEDIUM, name))
    assert all(figure.source for figure in figures.values())
