"""Frames of a program and of what runs it."""

from __future__ import annotations

from tests.cases import cases
from tests.running import Run

OWN_STACK = {
    "print_stack": (
        "traceback.print_stack()",
        ['  File "program.py", line 2, in f', "    def f(): traceback.print_stack()"],
    ),
    "walk_stack": (
        "[print(f.f_code.co_name) for f, _ in traceback.walk_stack(None)]",
        ["<listcomp>", "f", "<module>"],
    ),
    "print_exc": (
        "\n    try: time.sleep(-1)\n    except ValueError: traceback.print_exc()",
        [
            "    try: time.sleep(-1)",
            "         ^^^^^^^^^^^^^^",
            "ValueError: sleep length must be non-negative",
        ],
    ),
    "inspect": ("print([info.function for info in inspect.stack()])", ["['f', '<module>']"]),
    "refused": (
        "\n    try: faulthandler.dump_traceback()\n    except Exception as error: print(error.message)",
        ["faulthandler.dump_traceback is not part of the simulated brick"],
    ),
    "enabled": ("faulthandler.enable(); print(faulthandler.is_enabled())", ["True"]),
    "later": ("faulthandler.dump_traceback_later(1); print('on')", ["on"]),
}


@cases("text, told", OWN_STACK)
def test_a_program_that_inspects_the_stack_sees_only_its_own_frames(
    run: Run, text: str, told: list[str]
) -> None:
    done = run(
        f"import faulthandler, inspect, time, traceback\ndef f(): {text}\nf()", prelude="none"
    )
    assert done.ended.end == "finished"
    seen = [row.text for row in done.run.output.read_all_rows()]
    assert set(told) <= set(seen)
    assert not any("tuisim" in line or "runpy" in line for line in seen)
