"""Programs that are compiled before their processes are forked."""

from __future__ import annotations

import sys
import types
import warnings

import pytest

from tuisim.base.source import Program
from tuisim.engine.runtime import child
from tuisim.engine.runtime.child import MAX_CHARACTERS, MAX_KNOWN, KnownPrograms
from tuisim.engine.runtime.loader import LOOP_HOOK, compile_program


@pytest.mark.parametrize(
    "text",
    [
        "x = = 1",
        "x is 1\nif x is 1: pass",
        "'\\d'",
        "x = " + "-" * 5000 + "1",
        "#" * (MAX_CHARACTERS + 1),
    ],
    ids=["wrong", "with a warning", "with an ignored warning", "too deep", "too long"],
)
def test_a_program_with_warnings_or_errors_is_compiled_in_its_own_process(text: str) -> None:
    known = KnownPrograms()
    filters = list(warnings.filters)
    limit = sys.getrecursionlimit()
    assert [known.code(Program("p.py", text), False) for _ in range(3)] == [None, None, None]
    assert (warnings.filters, sys.getrecursionlimit()) == (filters, limit)


def test_a_program_run_a_second_time_is_compiled_once_and_remembered(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    known = KnownPrograms()
    program = Program("p.py", "for i in (1, 2): print(i)", path="/folder/p.py")
    compiled = []

    def compile_noted(text: str, file: str, drops_annotations: bool) -> types.CodeType:
        compiled.append(file)
        return compile_program(text, file, drops_annotations)

    monkeypatch.setattr(child, "compile_program", compile_noted)
    first, *others = [known.code(program, False) for _ in range(3)]
    assert (first, compiled) == (None, [program.file])
    assert others[0] is not None
    assert others[0] is others[1]
    turns: list[None] = []
    exec(others[0], {LOOP_HOOK: lambda: turns.append(None), "print": lambda _: None})
    assert len(turns) == 2


def test_the_same_text_under_another_file_name_is_compiled_anew() -> None:
    known = KnownPrograms()
    codes = [known.code(Program(name, "x = 1"), False) for name in ("a.py", "b.py", "a.py", "b.py")]
    assert [code and code.co_filename for code in codes] == [None, None, "a.py", "b.py"]


def test_a_program_compiled_without_annotations_is_remembered_separately() -> None:
    known = KnownPrograms()
    program = Program("p.py", "def f(a: b): pass")
    codes = [known.code(program, drops) for drops in (True, False, True, False)]
    names = [code and "b" in code.co_names for code in codes]
    assert names == [None, None, False, True]


def test_the_number_of_remembered_programs_is_limited() -> None:
    known = KnownPrograms()
    for number in range(3 * MAX_KNOWN):
        known.code(Program("p.py", f"x = {number}"), False)
    assert len(known._seen) <= MAX_KNOWN
