"""One language of conditions for breakpoints, go-to, filters, events, goals and expressions."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from types import SimpleNamespace
from typing import Any

import numpy as np
import pyarrow as pa
import pytest

from tests.cases import for_rows
from tuisim.analysis.events import FORM, Threshold, parse_events, parse_threshold
from tuisim.app.timeline import find, find_begins
from tuisim.base.errors import ConfigError, LogError
from tuisim.engine.breakpoints import Breakpoint
from tuisim.engine.core.conditions import (
    Edge,
    ValueCondition,
    ValueSource,
    parse_condition,
    parse_run_condition,
)
from tuisim.engine.core.profile import PROFILES
from tuisim.engine.core.spec import RobotSpec
from tuisim.engine.runs.frames import evaluate_condition
from tuisim.engine.runs.records import OutputRow, Stream
from tuisim.logs.columns import Layout
from tuisim.logs.expressions import evaluate
from tuisim.logs.log import Log
from tuisim.logs.table import Rows

VALUES = (40.0, 50.0, 60.0)


def by_breakpoint(condition: str) -> list[float]:
    rule = Breakpoint.parse(f"sample {condition}").rule
    assert isinstance(rule, ValueCondition)
    return [value for value in VALUES if Edge(rule).update(value)]


class OneRow:
    """A run that printed one value at its second tick."""

    def __init__(self, value: float) -> None:
        self._row = OutputRow(f"Colour: {value}", 1, 0, 1, Stream.STDOUT)

    def until(self, tick: int) -> int:
        return tick

    def rows(self, first: int, step: int = 1) -> Iterator[OutputRow]:
        return iter([self._row])


def by_goto(condition: str) -> list[float]:
    found = []
    for value in VALUES:
        spec = SimpleNamespace(profile=next(iter(PROFILES.values())), robot=RobotSpec())
        recording = SimpleNamespace(newest=9, rows=OneRow(value), spec=spec)
        timeline: Any = SimpleNamespace(recording=recording, tick=0, tick_hz=100)
        try:
            found += [value] * find(f"sample {condition}", timeline)
        except ConfigError as error:
            if "no sample" not in error.message:
                raise
    return found


def by_filter(condition: str) -> list[float]:
    rows = Rows(Log("test", pa.table({"Colour": VALUES, "word": ["a b", "> 5", ""]}), Layout()))
    rows.view = rows.build_filtered_view(rows.parse_conditions(condition))
    return [VALUES[rows.row(place)] for place in range(len(rows))]


def by_expression(condition: str) -> list[float]:
    held = evaluate(condition, {"Colour": np.array(VALUES)})
    return [value for value, one in zip(VALUES, held, strict=True) if one]


PLACES: Mapping[str, Callable[[str], list[float]]] = {
    "breakpoint": by_breakpoint,
    "go to": by_goto,
    "filter": by_filter,
    "expression": by_expression,
}
HELD = {
    "Colour < 50": [40],
    "Colour<=50": [40, 50],
    "Colour > 5e1": [60],
    "Colour >= +50": [50, 60],
    "Colour = 50": [50],
    "Colour=50.": [50],
    "Colour == 50": [50],
    "Colour==50": [50],
    "Colour != 50": [40, 60],
}


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("condition, expected", HELD.items(), ids=HELD)
def test_a_comparison_means_the_same_in_goals_breakpoints_and_logs(
    place: str, condition: str, expected: list[float]
) -> None:
    assert PLACES[place](condition) == expected


@pytest.mark.parametrize("condition", ["x < 2", "x >= 2", "x != 1", "x changes"])
def test_an_edge_is_found_in_a_recording_where_it_was_met_during_the_run(condition: str) -> None:
    values = np.random.default_rng(2).integers(0, 4, 300).astype(float)
    found = parse_condition(condition)
    assert found is not None
    edge = Edge(found)
    met = [at for at, value in enumerate(values.tolist()) if edge.update(value)]
    assert find_begins(found, evaluate_condition(found, values)).tolist() == met
    assert 50 < len(met) < 250


RUN_CONDITIONS = {
    "left_color changes": ValueCondition("left_color", "changes"),
    "sample Colour < 5": ValueCondition("Colour", "<", "5", ValueSource.SAMPLE),
    "sample": ValueCondition("", "is seen", "", ValueSource.SAMPLE),
    "print matches a = b": ValueCondition("", "matches", "a = b", ValueSource.PRINT),
    "sample 1x < 3": None,
    "print a": None,
    "x ~ 3": None,
    "x": None,
    "changes": None,
}


@for_rows("text, condition", RUN_CONDITIONS.items())
def test_parse_run_condition_reads_each_form_of_condition(
    text: str, condition: ValueCondition | None
) -> None:
    assert parse_run_condition(text) == condition


EVENTS = {
    "Colour < 50": (False,),
    "Colour>50": (True,),
    "Colour = 50": (False, True),
    "Colour == 50": (False, True),
    "Colour > 50 +- 2": (True,),
    "Colour changes": (False, True),
    "Colour>50±-2e-1": None,
    " Colour < +5.e1 ": (False,),
}


@for_rows("text, rising", EVENTS.items())
def test_an_events_comparison_sets_whether_it_rises_or_falls(
    text: str, rising: tuple[bool, ...] | None
) -> None:
    log = Log("test", pa.table({"Colour": [60.0, 40.0, 60.0]}), Layout(values=("Colour",)))
    (threshold,) = parse_events(text, log)
    assert isinstance(threshold, Threshold)
    if rising is None:
        # A negative width is read, and refused where it is used.
        assert threshold.hysteresis == -0.2
    else:
        assert (
            tuple(crossing.rising for crossing in threshold.find_crossings(log.series("Colour")))
            == rising
        )


@pytest.mark.parametrize(
    "text, name",
    [
        ("a > 5 > 0.5", "a > 5"),
        ("a+-5 < 3", "a+-5"),
        ("a~b = 1 +- 2", "a~b"),
        ("t (s) < 1", "t (s)"),
    ],
)
def test_variable_names_in_conditions_may_contain_operators(text: str, name: str) -> None:
    threshold = parse_threshold(text)
    assert threshold is not None
    assert threshold.name == name


def by_event(condition: str) -> None:
    parse_events(condition, Log("test", pa.table({"Colour": VALUES}), Layout(values=("Colour",))))


ALL = "< <= > >= = !="
REFUSED = {
    "breakpoint": ALL,
    "go to": ALL,
    "filter": f"{ALL} ~",
    "expression": ALL,
    "event": "< > =",
}


@pytest.mark.parametrize("place, operators", REFUSED.items(), ids=REFUSED)
@pytest.mark.parametrize("condition", ["Colour ? 50", "? 50"])
def test_a_text_that_is_no_comparison_is_refused_with_the_allowed_operators(
    place: str, operators: str, condition: str
) -> None:
    with pytest.raises((ConfigError, LogError)) as refused:
        (PLACES.get(place) or by_event)(condition)
    assert operators in refused.value.hint


@pytest.mark.parametrize("place", [place for place in PLACES if place != "expression"])
def test_a_condition_names_what_is_no_number(place: str) -> None:
    with pytest.raises((ConfigError, LogError), match="'ten' is not a number"):
        PLACES[place]("Colour < ten")


@pytest.mark.parametrize("condition", ["Colour <= 50", "Colour != 50", "Colour >= 50"])
def test_an_event_with_another_operator_is_refused(condition: str) -> None:
    with pytest.raises(LogError, match="is not a threshold") as refused:
        by_event(condition)
    assert refused.value.hint == FORM
