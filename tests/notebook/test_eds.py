"""Spans of time on an axis."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import matplotlib as mpl
import matplotlib.pyplot as plt
import pandas as pd
import seaborn as sns  # type: ignore[import-untyped]

from tests.cases import cases
from tuisim.notebook.eds import use_seconds

FRAME = pd.DataFrame(
    {"index": pd.to_timedelta([0, 0.5, 1.2], unit="s"), "variable": "a", "value": [1.0, 2.0, 3.0]}
)

CHARTS: dict[str, Callable[[], Any]] = {
    "seaborn's lines": lambda: sns.lineplot(x="index", y="value", hue="variable", data=FRAME),
    "seaborn's points": lambda: sns.scatterplot(x="index", y="value", data=FRAME),
    "a grid": lambda: (
        sns.FacetGrid(FRAME, row="variable").map(plt.plot, "index", "value").axes[0, 0]
    ),
    "matplotlib's lines": lambda: plt.plot(FRAME["index"], FRAME["value"])[0].axes,
}


@cases("draw", CHARTS)
def test_a_chart_axis_of_time_spans_is_in_seconds(draw: Callable[[], Any]) -> None:
    mpl.use("Agg")
    use_seconds()
    plt.figure()
    axes = draw()
    axes.figure.canvas.draw()
    labels = [label.get_text() for label in axes.get_xticklabels()]
    assert {"0 s", "1 s"} <= {*labels}
    assert axes.xaxis.get_offset_text().get_text() == ""
    # As before, for a cell that sets limits of its own.
    assert axes.get_xlim()[1] > 1e9
    plt.close("all")


def test_a_chart_axis_of_plain_numbers_is_not_labelled_in_seconds() -> None:
    use_seconds()
    _, axes = plt.subplots()
    axes.plot([0, 1, 2], [0, 1, 2])
    axes.figure.canvas.draw()
    assert not any("s" in label.get_text() for label in axes.get_xticklabels())
    plt.close("all")
