"""Values of awkward programs, looked at while they are held."""

from __future__ import annotations

import pytest

from tests.engine.runtime.awkward import PROGRAMS
from tests.engine.runtime.debugging import Driver
from tests.running import Start
from tuisim.engine.protocol import LineStep, StepLine

LOOKS: dict[str, tuple[str, str | tuple[str, ...]]] = {
    "repr that raises": ("r", "<repr raised ValueError: no repr>"),
    # The second where the machine is busy, and the whole look takes too long.
    "repr that loops": ("r", ("<repr takes too long>", "<R, not shown: values take too long>")),
    "repr that recurses": ("r", "<repr calls itself without end>"),
    "repr of no text": ("r", "<repr raised TypeError: __repr__ returned non-string (type int)>"),
    "repr of 20 MB": ("r", "x" * 300),
    "repr with effects": ("r", "<repr raised RuntimeError: the program is paused"),
    "long list": ("data", "[0, 1, 2, 3"),
    "huge numbers and texts": ("n", "<whole number of 561471 bits>"),
}


@pytest.mark.slow_cases("repr that loops", "repr of 20 MB")
@pytest.mark.parametrize("name, shown", LOOKS.items(), ids=LOOKS)
def test_hostile_values_are_shown_shortened_without_harming_the_program(
    start: Start, name: str, shown: tuple[str, str | tuple[str, ...]]
) -> None:
    text = PROGRAMS[name]
    driver = Driver(start(text, live=True, speed=0.0, breaks=(str(text.count("\n")),)))
    driver.paused()
    variable, value = shown
    assert driver.values()[variable].startswith(value)
    ended = driver.finish(StepLine(LineStep.OUT))
    assert ended.end == "finished"
    # What was done for a look is undone.
    assert driver.run.output.read_all_rows()[-1].text in ("on", "0", "49995000", "10000000")


@pytest.mark.quick_cases("repr that ends the program")
@pytest.mark.parametrize(
    "name", ["repr that cannot be stopped", "repr stuck in C", "repr that ends the program"]
)
def test_a_value_whose_repr_never_ends_does_not_hide_the_other_variables(
    start: Start, name: str
) -> None:
    text = PROGRAMS[name]
    driver = Driver(start(text, live=True, speed=0.0, breaks=(str(text.count("\n")),)))
    driver.paused()
    looked = driver.look("1 + 1")
    assert looked.stack
    assert looked.note.endswith("take too long")
    assert ("r", "<R, not shown: values take too long>") in [
        (v.name, v.value) for v in looked.variables
    ]
    assert driver.finish(StepLine(LineStep.OUT)).end == "finished"


def test_imported_names_are_not_shown_as_variables(start: Start) -> None:
    text = "from time import time\nfrom math import sqrt\nimport random\nx = 1\nprint(x)\n"
    driver = Driver(start(text, live=True, speed=0.0, breaks=("5",)))
    driver.paused()
    assert driver.values() == {"x": "1"}
    assert driver.finish(StepLine(LineStep.OUT)).end == "finished"
