"""Collaborative mode: a program talks with a function of the notebook, and asks the person at it."""

from __future__ import annotations

import json
from collections.abc import Callable

import pytest

from tests.notebook.conftest import Cell, Kernel
from tests.running import PATIENCE_S
from tuisim.commands.guide import find_page

TALK = """\
%%sim_magic_preloaded -b Grey_bands -x 300 -RWL
from ev3dev2_glue import pyState, get_clock
for grey in (220, 211):
    print('PY::' + str(grey))
    print('Answers:', len(pyState()['messages']))
    time.sleep(0.1)
print(pyState(), get_clock())
""".replace("from ev3", "import time\nfrom ev3")


def test_a_responder_gets_only_lines_printed_for_it(cell: Cell) -> None:
    cell("heard = []\nroboSim.responder = heard.append")
    text = "%%sim_magic_preloaded -RW{}\nprint('PY::hello')\nprint('other')\nprint('IMG_DATA left')"
    cell(text.format(""))
    assert cell("heard").result == []
    cell(text.format("L"))
    assert cell("heard").result == ["hello", "IMG_DATA left"]


def test_the_program_gets_what_the_responder_returned(cell: Cell) -> None:
    cell("roboSim.responder = lambda text: {'half': int(text) / 2}")
    first = cell(TALK).out.splitlines()
    assert first == [
        "PY::220",
        "Answers: 1",
        "PY::211",
        "Answers: 2",
        "{'messages': [{'half': 110.0}, {'half': 105.5}]} 0.2",
    ]
    slow = "import time\ndef slow(text):\n    time.sleep(0.1)\n    return {'half': int(text) / 2}\n"
    cell(slow + "roboSim.responder = slow")
    assert cell(TALK).out.splitlines() == first
    bits = [
        (run.folder / "telemetry.bin").read_bytes() for run in cell("roboSim.results_log").result
    ]
    assert bits[0] == bits[1]


ANSWERS = [
    ("None", "[]"),
    ("'text'", "['text']"),
    ("[1, (2, 'three')]", "[[1, [2, 'three']]]"),
    ("__import__('numpy').int64(7)", "[7]"),
    ("{'grey': __import__('numpy').eye(2)}", "[{'grey': [[1.0, 0.0], [0.0, 1.0]]}]"),
]


@pytest.mark.slow
@pytest.mark.parametrize("answer, got", ANSWERS, ids=[answer for answer, _ in ANSWERS])
def test_a_responders_answer_reaches_the_program_as_json(answer: str, got: str, cell: Cell) -> None:
    cell(f"roboSim.responder = lambda text: {answer}")
    text = "%%sim_magic -RWL\nfrom ev3dev2_glue import pyState\nprint('PY::?')\nprint(pyState()['messages'])"
    assert cell(text).out == f"PY::?\n{got}\n"


def test_without_collaborative_mode_the_responder_is_not_called(cell: Cell) -> None:
    cell("roboSim.responder = lambda text: 1 / 0")
    text = "%%sim_magic -RW\nfrom ev3dev2_glue import pyState\nprint('PY::?')\nprint(pyState())"
    assert cell(text).out == "PY::?\n{'messages': []}\n"


OLD_ANSWERS = [
    ("None", "", []),
    ("'0'", "PY RESPONSE\n0\n", []),
    ("{'a': 1}", "PY RESPONSE\n{'a': 1}\n", []),
    ("'JSON::[1, null]'", "PY RESPONSE\nJSON::[1, null]\n", [[1, None]]),
    ("text", "PY RESPONSE\nPY::0\n", []),
    ("' JSON::1'", "PY RESPONSE\n JSON::1\n", []),
]
"""What a `pyresponder` returns, what the cell shows of it, and what the program gets."""


@pytest.mark.parametrize(
    "answer, shown, got", OLD_ANSWERS, ids=[answer for answer, _, _ in OLD_ANSWERS]
)
def test_a_pyresponder_gets_and_returns_texts(
    answer: str, shown: str, got: list[object], cell: Cell
) -> None:
    cell(
        f"heard = []\ndef respond(text):\n    heard.append(text)\n    return {answer}\nroboSim.pyresponder = respond"
    )
    text = "from ev3dev2_glue import pyState\nprint('PY::0')\nprint('other')\nprint(pyState()['messages'])"
    assert cell(f"%%sim_magic -RW --collab\n{text}").out == f"PY::0\n{shown}other\n{got}\n"
    assert cell("heard").result == ["PY::0"]


def test_a_pyresponder_gets_the_pixels_as_text(cell: Cell) -> None:
    cell("heard = []\nroboSim.pyresponder = heard.append")
    text = "print('image_data both')\nprint('IMG_DATA')\nprint('IMG_DATA left')"
    cell(f"%%sim_magic_preloaded -b Grey_bands -x 1520 -RWHL\n{text}")
    heard = cell("heard").result
    records = cell("roboSim.raw_image_data").result
    assert heard[0] == heard[1]
    begin, _, sent = heard[0].partition("::")
    sides = {record.split(" ")[0]: record.split(" ")[1] for record in records}
    assert (begin, json.loads(sent)) == ("IMG_DATA", sides)
    assert list(sides) == ["left", "right"]


@pytest.mark.parametrize("names", [("responder", "pyresponder"), ("pyresponder", "responder")])
def test_the_responder_that_was_set_last_answers(names: tuple[str, str], cell: Cell) -> None:
    cell(
        "first, second = [], []\n"
        f"roboSim.{names[0]} = first.append\nroboSim.{names[1]} = second.append"
    )
    cell("%%sim_magic -RWL\nprint('PY::hello')")
    assert cell("first, second").result == (
        [],
        ["PY::hello" if names[1] == "pyresponder" else "hello"],
    )
    assert cell(f"roboSim.{names[0]}").result is None


def test_a_responder_sees_the_pixels_that_are_sent_to_it(cell: Cell) -> None:
    cell(
        "def dark(line):\n    frame = roboSim.images()\n    assert list(frame.side) == ['left'], line\n"
        "    return int(eds.bw_image_data(frame).to_numpy().sum())\nroboSim.responder = dark"
    )
    text = "from ev3dev2_glue import pyState\nprint('IMG_DATA left')\nprint(pyState()['messages'])"
    out = cell(f"%%sim_magic_preloaded -b Grey_bands -x 1520 -RWL\n{text}").out
    # The disc lies on the black band.
    assert out.splitlines()[-1] == "[305]"


def test_the_guides_example_of_a_responder_gives_the_printed_answer(cell: Cell) -> None:
    blocks = find_page("notebooks").source.split("```python notebook\n")[1:]
    responder, program = (
        text
        for block in blocks
        if "responder =" in (text := block.partition("```")[0]) or "pyState" in text
    )
    cell(responder)
    assert cell(program).out.splitlines()[-1] == program.partition("# ")[2].strip()


@pytest.mark.slow
def test_a_responder_may_run_another_program(cell: Cell) -> None:
    cell(
        "def measure(text):\n    get_ipython().run_cell_magic('sim_magic', '-RWH', \"print('Inner: 1')\")\n"
        "roboSim.responder = measure"
    )
    cell(
        "%%sim_magic -RWL\nprint('PY::?')\nfrom ev3dev2_glue import pyState\npyState()\nprint('Outer: 2')"
    )
    frame = cell("%sim_data").result
    assert list(zip(frame.run, frame.variable, strict=True)) == [(1, "Outer"), (2, "Inner")]


MISTAKES = [
    pytest.param(
        "lambda text: object()",
        "roboSim.responder: the program cannot get a object",
        id="an object",
    ),
    pytest.param(
        "lambda text: {1j: 2}",
        "roboSim.responder: the program cannot get keys must be str",
        id="a key",
    ),
    pytest.param(
        "'no function'",
        "roboSim.responder: must be a function, got 'no function'",
        id="no function",
    ),
]
OLD_MISTAKES = [
    pytest.param(
        "'no function'",
        "roboSim.pyresponder: must be a function, got 'no function'",
        id="no function",
    ),
    pytest.param(
        "lambda text: 'JSON::{'", "roboSim.pyresponder: the answer is not JSON: ", id="no JSON"
    ),
]


@pytest.mark.slow_cases("a key")
@pytest.mark.parametrize("responder, told", MISTAKES)
def test_setting_a_wrong_responder_is_refused_in_one_line(
    responder: str, told: str, cell: Cell
) -> None:
    cell(f"roboSim.responder = {responder}")
    shown = cell("%%sim_magic -RWL --speed 1\nprint('PY::?')\nwhile True:\n    pass\n")
    assert shown.err.startswith(f"tuisim: {told}")
    assert shown.err.count("\n") == 1
    # Its last state stays in the cell, where the program ran at all.
    assert ("stopped · " in shown.plain) == (responder != "'no function'")
    assert cell("%%sim_magic -RW\nprint('next')").out == "next\n"


@pytest.mark.parametrize("responder, told", OLD_MISTAKES)
def test_setting_a_wrong_pyresponder_is_refused_in_one_line(
    responder: str, told: str, cell: Cell
) -> None:
    cell(f"roboSim.pyresponder = {responder}")
    shown = cell("%%sim_magic -RWL --speed 1\nprint('PY::?')\nwhile True:\n    pass\n")
    assert shown.err.startswith(f"tuisim: {told}")
    assert shown.err.count("\n") == 1


@pytest.mark.slow
def test_an_error_in_a_responder_is_raised_in_the_cell_and_stops_the_run(cell: Cell) -> None:
    cell("roboSim.responder = lambda text: 1 / 0")
    with pytest.raises(ZeroDivisionError):
        cell("%%sim_magic -RWL\nprint('PY::?')\nwhile True:\n    pass\n")
    assert cell("roboSim.results_log[-1].state").result == "stopped"
    assert cell("%%sim_magic -RW\nprint('next')").out == "next\n"


ASKS = "%%sim_magic -RW\nfrom ev3dev2_glue import get_clock\nprint('Hello', input('Name? '), get_clock())"


def test_an_answer_to_input_in_a_cell_takes_no_simulated_time(
    cell: Cell, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[str] = []

    def answer(prompt: str) -> str:
        asked.append(prompt)
        return "Ada"

    monkeypatch.setattr("builtins.input", answer)
    assert (cell(ASKS).out, asked) == ("Hello Ada 0.0\n", ["Name? "])


def failing(error: type[Exception]) -> Callable[[str], str]:
    def ask(prompt: str) -> str:
        raise error

    return ask


@pytest.mark.parametrize("error", [EOFError, OSError])
def test_a_cell_says_so_where_nobody_can_answer_its_program(
    error: type[Exception], cell: Cell, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("builtins.input", failing(error))
    shown = cell(ASKS)
    assert shown.err.startswith(
        "tuisim: the program waits for input(), which is not supported here\n"
    )
    assert "EOFError: there is no further answer to input()" in shown.err


@pytest.mark.slow
def test_a_kernel_asks_its_user_for_a_programs_input(kernel: Kernel) -> None:
    parent = kernel.client.execute(ASKS, allow_stdin=True)
    question = kernel.client.get_stdin_msg(timeout=PATIENCE_S)
    assert question["content"]["prompt"] == "Name? "
    kernel.client.input("Ada")
    kernel.message(parent, lambda message: message["content"].get("text") == "Hello Ada 0.0\n")
    kernel.idle(parent)
