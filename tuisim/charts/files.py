"""Charts as files; the suffix selects the format."""

from __future__ import annotations

import io
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from tuisim.atomic import replacing
from tuisim.charts.figure import Chart, View, chart_of
from tuisim.charts.layout import laid_out
from tuisim.errors import ExportError
from tuisim.logs.export import check_place

if TYPE_CHECKING:
    from tuisim.analysis.model import Model

Size = tuple[int, int]


@dataclass(frozen=True, slots=True)
class ChartFormat:
    """One line of `CHART_FORMATS`."""

    write: Callable[[Chart, Size], bytes]
    size: Size
    """Default width and height."""
    least: Size
    most: Size
    unit: str
    """Unit of the size."""
    finer: Size = (1, 1)
    """Resolution: subdivisions of a unit."""


def _svg(chart: Chart, size: Size) -> bytes:
    from tuisim.charts.svg import svg_of

    return svg_of(laid_out(chart, *size)).encode()


def _png(chart: Chart, size: Size) -> bytes:
    from tuisim.charts.png import image_of

    content = io.BytesIO()
    image_of(laid_out(chart, *size)).save(content, "png")
    return content.getvalue()


def _text(chart: Chart, size: Size) -> bytes:
    from tuisim.charts.text import text_of

    return f"{text_of(chart, *size).plain}\n".encode()


CHART_FORMATS: Mapping[str, ChartFormat] = {
    ".svg": ChartFormat(_svg, (960, 420), (200, 150), (10_000, 10_000), "pixels"),
    ".png": ChartFormat(_png, (960, 420), (200, 150), (6_000, 6_000), "pixels"),
    ".txt": ChartFormat(_text, (80, 24), (20, 8), (1_000, 500), "characters", (2, 4)),
}
"""Every format of a chart by the suffix of its files. To add one: write its function and a line here."""

FACET_PX = 200
"""Default height of a facet in an image."""


def format_of(path: Path) -> ChartFormat:
    """Return the format for a file's suffix; check that the file can be written.

    Raises:
        ExportError: unknown suffix, or it cannot be written.
    """
    found = CHART_FORMATS.get(path.suffix.lower())
    if found is None:
        allowed = ", ".join(CHART_FORMATS)
        raise ExportError(f"cannot write {path}: unknown format {path.suffix!r}", f"a chart ends in {allowed}")
    check_place(path)
    return found


def save_chart(model: Model, view: View, path: Path, size: Size | None = None) -> None:
    """Write a model's chart to a file; one that is there is replaced.

    Args:
        model: The log.
        view: How it is looked at.
        path: The suffix says the format, one of `CHART_FORMATS`.
        size: Width and height in the format's unit; None for its own.

    Raises:
        ExportError: the file cannot be written; what was there is as it was.
        LogError: no such variable to draw against.
    """
    kind = format_of(path)
    width, height = size or kind.size
    chart = chart_of(model, view, width * kind.finer[0], height * kind.finer[1])
    if chart.facets and size is None and kind.unit == "pixels":
        height = max(height, 80 + FACET_PX * len(chart.lines))
    write_whole(path, kind.write(chart, (width, height)))


def write_whole(path: Path, content: bytes) -> None:
    """Write a file atomically.

    Raises:
        ExportError: it cannot be written; what was there is as it was.
    """
    try:
        with replacing(path) as handle:
            handle.write(content)
    except OSError as error:
        raise ExportError(f"cannot write {path}: {error.strerror or error}") from error
