"""Variables that are derived from those of a log, as they are typed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tuisim.datalog.analysis.derived import definition_of, derived
from tuisim.datalog.analysis.logreckon import RECKONED, reckoned_series
from tuisim.errors import LogError

if TYPE_CHECKING:
    from tuisim.datalog.opening import Log
    from tuisim.ui.analyser.model import Model

RECKONING = "reckoning"
"""Line that asks for what the wheels say."""


def derive(model: Model, text: str) -> None:
    """Derive a variable, at once.

    Raises:
        LogError: as for `with_definition`.
    """
    take(model, *with_definition(model, text))


def take(model: Model, text: str, log: Log) -> None:
    """Let a model have what was derived."""
    name = RECKONING if text == RECKONING else definition_of(text).name
    model.definitions.pop(name, None)
    if text == RECKONING or definition_of(text).expression:
        model.definitions[name] = text
    model.take_log(log)
    shown = RECKONED[-1] if name == RECKONING else name
    model.selected = next((one for one in log.derived if one.partition(" #")[0] == shown), model.selected)


def with_definition(model: Model, text: str) -> tuple[str, Log]:
    """Return a line as it was typed, and the log with what it defines.

    Raises:
        LogError: the line cannot be read, names what there is not, or there is no such variable to take away.
    """
    text = text.strip()
    log = model.log
    if text == RECKONING:
        for column in RECKONED:
            log = log.without_derived(column)
        for series in reckoned_series(log):
            log = log.with_derived(series.name, [series])
        return text, log
    definition = definition_of(text)
    bare = log.without_derived(definition.name)
    if definition.expression:
        return text, bare.with_derived(definition.name, derived(bare, definition, model.selected))
    if bare is log:
        made = dict.fromkeys(name.partition(" #")[0] for name in log.derived)
        raise LogError(f"no derived variable {definition.name!r}", f"there are {', '.join(made) or 'none'}")
    return text, bare
