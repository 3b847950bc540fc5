"""Files of charts and reports: every format, whole or not at all."""

from __future__ import annotations

import os
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from tests.app.analyser.logs import long_log, model_of
from tuisim.analysis.chart import View, build_chart
from tuisim.analysis.report import build_default_name, build_report, write_report
from tuisim.analysis.source import LogRequest, OpenedLog
from tuisim.base.errors import ExportError, LogError
from tuisim.logs.log import Log
from tuisim.pictures.charts.files import CHART_FORMATS, draw_image, parse_size, save_chart
from tuisim.pictures.charts.layout import Drawing, Raster, Shade, Stroke

each_format = pytest.mark.parametrize("suffix", CHART_FORMATS)


@each_format
@pytest.mark.parametrize("facets", [False, True], ids=["one", "facets"])
def test_every_format_of_chart_files_has_its_own_default_size(
    tmp_path: Path, suffix: str, facets: bool
) -> None:
    kind = CHART_FORMATS[suffix]
    assert all(
        low <= side <= high
        for low, side, high in zip(kind.smallest, kind.size, kind.largest, strict=True)
    )
    written = []
    for name, size in (("own", None), ("least", kind.smallest), ("least_again", kind.smallest)):
        target = tmp_path / f"{name}{suffix.upper()}"
        save_chart(partial(build_chart, model_of(long_log()), View(facets=facets)), target, size)
        written.append(target.read_bytes())
    assert len(written[0]) > len(written[1]) > 50
    assert written[1] == written[2]


def full(_: int) -> None:
    raise OSError(28, "No space left on device")


@each_format
def test_a_failed_chart_export_leaves_the_old_file(
    tmp_path: Path, suffix: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    target = tmp_path / f"x{suffix}"
    target.write_text("old")
    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(ExportError, match=f"cannot write .*x{suffix}: No space left on device"):
        save_chart(partial(build_chart, model_of(long_log()), View()), target)
    assert (target.read_text(), list(tmp_path.iterdir())) == ("old", [target])


def test_a_failed_report_leaves_the_old_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    target = tmp_path / "x.html"
    target.write_text("old")
    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(ExportError, match=r"cannot write .*x\.html: No space left on device"):
        write_report(OpenedLog(LogRequest(), long_log()), target)
    assert (target.read_text(), list(tmp_path.iterdir())) == ("old", [target])


@pytest.mark.parametrize(
    "file, name",
    [("a/greys.csv", "greys-report.html"), ("-", "log-report.html"), (".csv", "csv-report.html")],
)
def test_a_reports_default_file_name_is_that_of_its_log(file: str, name: str) -> None:
    assert build_default_name(OpenedLog(LogRequest(file=file), long_log())) == name


def test_a_report_of_a_log_with_odd_metadata_escapes_it_and_does_not_fail() -> None:
    log = long_log()
    odd = {
        "runs": [
            {"world": "<none>", "seed": {"x": 1}, "program": {"name": "<p>", "sha256": 3}},
            7,
            None,
        ]
    }
    page = build_report(OpenedLog(LogRequest(), replace(log, metadata=odd)))
    assert (
        "<td>&lt;p&gt;</td>" in page
        and "<p>" not in page.split("<h2>Facts</h2>")[1].split("</section>")[0]
    )


def test_a_report_of_a_log_without_rows_is_refused() -> None:
    empty = Log("test", long_log().table.slice(0, 0), long_log().layout)
    with pytest.raises(LogError, match="no rows"):
        build_report(OpenedLog(LogRequest(), empty))


def test_each_shape_of_a_drawing_has_its_size_in_the_image() -> None:
    points = np.array([[10.0, 10.0], [30.0, 10.0]])
    shapes = (
        Stroke(points, (255, 0, 0), dots=True),
        Stroke(points + np.array([0, 20]), (0, 0, 255)),
        Shade(10, 45, 20, 10),
        Raster(10, 65, 20, 10, np.zeros((2, 2, 3), np.uint8)),
    )
    image = np.asarray(draw_image(Drawing("", 40, 80, shapes))).astype(int)
    is_inked = (image < 250).any(axis=2).reshape(4, 20, 40)
    sizes = [[int(np.ptp(places)) + 1 for places in part.nonzero()] for part in is_inked]
    assert sizes == [[7, 27], [3, 24], [11, 21], [12, 22]]


@pytest.mark.parametrize(
    "text, size",
    [
        ("800x600", (800, 600)),
        ("200×150", (200, 150)),
        ("6000x6000", (6000, 6000)),
        ("199x150", None),
        ("200x149", None),
        ("6001x150", None),
        ("800", None),
    ],
)
def test_the_size_of_a_chart_picture_has_limits(text: str, size: tuple[int, int] | None) -> None:
    assert parse_size(text, (200, 150), (6000, 6000)) == size
