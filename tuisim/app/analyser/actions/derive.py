"""The prompt for a derived variable."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from tuisim.analysis.model import RECKONING, derive, take, with_definition
from tuisim.app.analyser.background import work
from tuisim.app.analyser.prompt import Form, LinePrompt
from tuisim.logs.columns import is_numeric
from tuisim.logs.derived import NEEDED, SIGNALS, TIME
from tuisim.logs.expressions import CONSTANTS, FUNCTIONS

if TYPE_CHECKING:
    from tuisim.analysis.model import Model
    from tuisim.app.analyser.screen import Analyser
    from tuisim.logs.log import Log

_FORMS: tuple[Form, ...] = (
    ("speed = slope(x_mm)", "change a second; a name before it if you like"),
    ("average(Colour, 5)", "mean of the 5 samples around each"),
    ("integral(Colour)", "sum over time"),
    ("resample(Colour, 0.1)", "at even moments, every 0.1 s"),
    ("(Left + Right) / 2", "+ - * / // % ** < > == and or not, a if b else c"),
    ("speed =", "removes it again"),
)
_RECKONING: Form = (RECKONING, "the pose by dead reckoning, and the error_mm")


def ask(screen: Analyser) -> None:
    """Ask for a derived variable."""
    model = screen.model
    if model is None:
        return

    def go(text: str) -> None:
        model = screen.at_hand()
        work(screen, "computing …", model.log.rows, lambda _: (model, *with_definition(model, text)), taken)

    def taken(made: tuple[Model, str, Log]) -> None:
        of, text, log = made
        model = screen.at_hand()
        if model is of:
            take(model, text, log)
        else:
            # The log may have grown meanwhile.
            derive(model, text)
        screen.redraw_chart()
        screen.update()

    can_reckon = set(NEEDED) <= set(model.log.table.column_names)
    forms = (*_FORMS, *((_RECKONING,) if can_reckon else ()), ("functions", ", ".join(FUNCTIONS)))
    screen.app.push_screen(LinePrompt("Derive a variable", go, forms=forms, words=tuple(words(model.log))))


def words(log: Log) -> Iterator[str]:
    """Yield the words allowed in an expression: variables, columns, functions."""
    columns = (at.name for at in log.table.schema if is_numeric(at.type))
    known = dict.fromkeys((*(name.partition(" #")[0] for name in log.names), *columns, TIME))
    yield from (name if name.isidentifier() else f"`{name}`" for name in known)
    yield from (f"{name}(" for name in (*SIGNALS, *FUNCTIONS))
    yield from CONSTANTS
    yield RECKONING
