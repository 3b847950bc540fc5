"""Tables of checks: expressions that a program evaluates in the real child, and what each must show."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

import pytest

from tests.engine.shim.conftest import RunOn


@dataclass(frozen=True)
class Check:
    """One line of a program."""

    text: str
    """An expression, or statements."""
    shows: str = "None"
    """`repr` of its value, or the error's type (and text, as far as given here)."""
    ids: str = ""
    """What this exercises: it would show something else if one of these did nothing. Names without their module."""


@dataclass(frozen=True)
class Table:
    """Checks that one program makes, one after the other."""

    module: str
    """The module that the ids belong to; `other.module:Name` names another one."""
    setup: str
    checks: tuple[Check, ...]
    presses: tuple[str, ...] = ()
    """Buttons of the brick that are pressed meanwhile, as `tuisim run --press` takes them."""

    @property
    def program(self) -> str:
        """The text to run: it prints one line for each check."""
        lines = [self.setup, _SHOW]
        lines += [f"_show({check.text!r})" for check in self.checks]
        return "\n".join(lines)

    @property
    def ids(self) -> set[str]:
        """Full ids of everything exercised."""
        names = {name for check in self.checks for name in check.ids.split()}
        return {name if ":" in name else f"{self.module}:{name}" for name in names}


_SHOW = """
def _show(text):
    try:
        try:
            code = compile(text, 'check', 'eval')
        except SyntaxError:
            exec(compile(text, 'check', 'exec'), globals())
            print('None')
        else:
            print(repr(eval(code, globals())))
    except Exception as error:
        print(type(error).__name__ + ':', error)
"""


def differences(table: Table, lines: list[str]) -> list[str]:
    """Return the checks that showed something else, each as a line."""
    found = []
    for check, line in zip(table.checks, lines, strict=False):
        as_error = re.match(r"[A-Z]\w+: ", line) and line.startswith(check.shows)
        if line != check.shows and not as_error:
            found.append(f"{check.text!r}: shows {line!r}, not {check.shows!r}")
    if len(lines) != len(table.checks):
        found.append(f"{len(lines)} lines for {len(table.checks)} checks, last: {lines[-1:]}")
    return found


Tables = Mapping[str, tuple[Table, str, str]]
"""By name: table, robot, world."""


def cases(tables: Tables) -> pytest.MarkDecorator:
    """Let a test be called with each table, its robot and its world."""
    return pytest.mark.parametrize(("table", "robot", "world"), tables.values(), ids=tables)


def check(run_on: RunOn, table: Table, robot: str, world: str) -> None:
    """Run a table as a program, and make sure that each of its checks shows what it must."""
    done = run_on(table.program, robot, world, presses=table.presses)
    assert "\n".join(differences(table, done.lines)) == ""
    assert done.ended.end == "finished", done.errors
