"""The pictures of runs: what is drawn of many samples, and of a pen that is put down and lifted."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TypeVar

import numpy as np
import pytest

from tests.cases import cases
from tests.pictures.charts.test_layout import log_of
from tuisim.analysis.chart import View
from tuisim.analysis.chart import build_chart as plotted
from tuisim.base.source import Program
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.profile import ROBOLAB
from tuisim.engine.core.spec import RobotSpec, RunSpec, WorldSpec
from tuisim.engine.runs.run_folder import field_files
from tuisim.engine.runs.samples import Sample
from tuisim.notebook.display import CHART_SIZE, Scene, list_instruments, start_record
from tuisim.pictures.charts.files import draw_svg
from tuisim.pictures.charts.layout import ChartData, Stroke, Words
from tuisim.pictures.charts.sample_chart import build_sample_chart

Kind = TypeVar("Kind", Stroke, Words)
chart_of = partial(build_sample_chart, columns=CHART_SIZE[0])


def samples(count: int, peak: float) -> list[Sample]:
    return [
        Sample("Grey", peak if at == count // 3 else at % 7, at / count, at, at, 1)
        for at in range(count)
    ]


def drawn(chart: ChartData, kind: type[Kind]) -> list[Kind]:
    return [
        shape
        for shape in chart.lay_out(*CHART_SIZE, titled=False).shapes
        if isinstance(shape, kind)
    ]


def test_a_single_peak_among_many_samples_is_seen() -> None:
    few, many = (
        drawn(chart_of(samples(count, 100.0)), Stroke)[-1].points[:, 1] for count in (900, 50_000)
    )
    assert [many.min(), many.max()] == [few.min(), few.max()]
    assert many.max() - many.min() > CHART_SIZE[1] / 2


def test_a_notebooks_chart_draws_samples_as_log_plot_does() -> None:
    times = np.arange(5000) / 100
    values = np.sin(np.arange(5000)) * 90
    here = chart_of([Sample("Gyro", v, t, 0, 0, 1) for t, v in zip(times, values, strict=True)])
    model = log_of({"time": times.tolist(), "Gyro": values.tolist()})
    there = plotted(model, View(), *CHART_SIZE)
    drawings = [chart.lay_out(*CHART_SIZE, titled=False) for chart in (here, there)]
    assert draw_svg(replace(drawings[0], title="")) == draw_svg(replace(drawings[1], title=""))


@pytest.mark.parametrize(
    "read, words",
    [
        ("reflected_light_intensity", "red 255 of 255, mean 100.0 %"),
        ("reflected_light_intensity_pc", "red 100.0 %, mean 100.0 %"),
        ("full_reflected_light_intensity", "mean 100.0 %, red 100.0 %"),
    ],
)
def test_the_table_of_instruments_shows_the_number_that_the_program_reads(
    read: str, words: str
) -> None:
    spec = RunSpec(RobotSpec(), WorldSpec(background="Grey_bands"), ROBOLAB)
    asking = Program("prog.py", f"v = colorLeft.{read}\n", "preloaded")
    scene = Scene(spec, field_files(spec), asking, start_record(spec))
    rows = dict(list_instruments(scene))
    assert rows["Sensor1 (left)"].startswith(words)


def test_the_table_shows_gyro_0_for_a_robot_that_starts_turned() -> None:
    spec = RunSpec(RobotSpec(), WorldSpec(start=Pose(700, 500, 90)), ROBOLAB)
    rows = dict(list_instruments(Scene(spec, field_files(spec), None, start_record(spec))))
    assert rows["Gyro"].startswith("0")


@cases(
    "values",
    {
        "constant": [100.0] * 5,
        "nothing": [0.0] * 5,
        "huge": [1e300],
        "percent": [0.0, 100.0],
        "everything": [-1e308, 1e308],
        "almost everything": [-1e149, 1e149],
    },
)
def test_no_two_labels_of_a_notebooks_chart_are_equal(values: list[float]) -> None:
    rows = [Sample("Grey", value, at / 10, at, at, 1) for at, value in enumerate(values)]
    labels = [words.text for words in drawn(chart_of(rows), Words) if words.anchor == "end"]
    assert len(labels) == len(set(labels)) >= 3
    assert max(map(len, labels)) < 12
