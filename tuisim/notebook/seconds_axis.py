"""Spans of time on the axis of a chart: labelled in seconds, where matplotlib would count nanoseconds."""

from __future__ import annotations

from contextlib import suppress
from typing import Any

from tuisim.core.profile import NS_PER_S


def use_seconds() -> None:
    """Let matplotlib, and seaborn with it, label spans in seconds; nothing happens where it is not installed."""
    with suppress(ImportError):
        import numpy as np
        from matplotlib import ticker, units

        class Seconds(units.ConversionInterface):
            """Converts spans."""

            @staticmethod
            def convert(value: Any, unit: object, axis: object) -> Any:
                """Return spans in nanoseconds, as what is plotted without this converter; numbers are that already."""
                spans = np.asarray(value)
                is_span = spans.dtype.kind in "mO"
                return spans.astype("timedelta64[ns]").astype("float64") if is_span else value

            @staticmethod
            def axisinfo(unit: object, axis: object) -> units.AxisInfo:
                """Return how an axis shows them: its numbers are nanoseconds, its labels seconds."""
                seconds = ticker.FuncFormatter(lambda ns, _: f"{ns / NS_PER_S:g} s")
                return units.AxisInfo(majfmt=seconds, label="time")  # type: ignore[no-untyped-call]

        units.registry.setdefault(np.timedelta64, Seconds())
