"""The whole public library is there: every item resolves in the child with its own signature."""

from __future__ import annotations

import json
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import pytest

from tests.engine.shim.conftest import RunOn

HERE = Path(__file__).parent
SIMULATED = ("physics", "console", "pure")
"""Meanings of items that a simulated brick has to give; the others are plumbing of the real one."""


class Item(NamedTuple):
    """One public item of the library."""

    id: str
    meaning: str
    kind: str
    signature: str

    @property
    def module(self) -> str:
        """Its module's full name."""
        return self.id.split(":")[0]


def items() -> Iterator[Item]:
    """Yield every item of `api_items.txt`."""
    for line in (HERE / "api_items.txt").read_text().splitlines():
        yield Item(*(line + "\t\t\t").split("\t")[:4])


def exercised() -> set[str]:
    """Return the ids that some test exercises, by the files in `exercised/`."""
    return {
        line
        for file in (HERE / "exercised").glob("*.txt")
        for line in file.read_text().splitlines()
        if line and not line.startswith("#")
    }


WALK = """
import importlib, inspect, json

def names_used(cls):
    found = set()
    for base in cls.__mro__:
        found |= set(base.__dict__) | set(base.__dict__.get('__slots__', ()))
        for part in base.__dict__.values():
            part = getattr(part, '__wrapped__', part)
            code = getattr(part, '__code__', None)
            if code is not None:
                found |= set(code.co_names)
        first = inspect.unwrap(base.__init__)
        if hasattr(first, '__code__'):
            found |= set(first.__code__.co_names)
    return found

class Named:
    def __init__(self, thing):
        self.name = thing.__name__

    def __repr__(self):
        return self.name

def signature(thing):
    parameters = list(inspect.signature(thing).parameters.values())
    if parameters and parameters[0].name == 'self':
        parameters = parameters[1:]
    parameters = [
        part.replace(default=Named(part.default))
        if part.default is not part.empty and hasattr(part.default, '__name__')
        else part
        for part in parameters
    ]
    return str(inspect.Signature(parameters))

def look(item_id, kind, wanted):
    module, path = item_id.split(':')
    thing = owner = importlib.import_module(module)
    for name in path.split('.'):
        owner = thing
        if kind in ('attribute', 'handler') and name == path.split('.')[-1]:
            return '' if name in names_used(owner) else 'is not there'
        thing = getattr(owner, name)
    if wanted and signature(thing) != wanted:
        return 'has the signature ' + signature(thing) + ', not ' + wanted
    if kind == 'property' and not isinstance(inspect.getattr_static(owner, path.split('.')[-1]), property):
        return 'is no property'
    return ''

for item_id, kind, wanted in json.loads(ITEMS):
    try:
        wrong = look(item_id, kind, wanted)
    except Exception as error:
        wrong = type(error).__name__ + ': ' + str(error)
    if wrong:
        print(item_id, wrong)
print('looked')
"""


def test_every_name_of_ev3dev2_exists_with_its_signature(run_on: RunOn) -> None:
    wanted = [(item.id, item.kind, item.signature) for item in items()]
    assert len(wanted) == 849
    done = run_on(f"ITEMS = {json.dumps(wanted)!r}\n{WALK}")
    assert "\n".join(done.lines) == "looked", done.errors


def test_every_item_that_tests_exercise_is_in_the_library() -> None:
    assert exercised() <= {item.id for item in items()}


def test_tests_exercise_at_least_98_percent_of_the_library(
    capsys: pytest.CaptureFixture[str],
) -> None:
    done = exercised()
    counts: dict[str, list[int]] = defaultdict(lambda: [0, 0])
    for item in items():
        if item.meaning in SIMULATED:
            counts[item.module][0] += item.id in done
            counts[item.module][1] += 1
    with capsys.disabled():
        print("\nexercised items by module:")
        for module, (some, every) in counts.items():
            print(f"  {module:24} {some:3} of {every:3}")
    for module in OWN:
        some, every = counts[module]
        assert some >= 0.95 * every, module
    assert sum(counts[module][0] for module in OWN) >= 0.98 * sum(
        counts[module][1] for module in OWN
    )


OWN = (
    "ev3dev2",
    "ev3dev2.button",
    "ev3dev2.console",
    "ev3dev2.display",
    "ev3dev2.fonts",
    "ev3dev2.led",
    "ev3dev2.motor",
    "ev3dev2.sensor",
    "ev3dev2.sensor.lego",
    "ev3dev2.sound",
    "ev3dev2.stopwatch",
    "ev3dev2.version",
)
"""Modules that the simulated brick has; `unit` and `wheel` compute, and are the library's own."""
