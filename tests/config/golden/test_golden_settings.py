"""Settings from everywhere give the runs and the errors that they gave before they were modelled as they are.

The golden file was written by earlier code, see `make`; `differences.toml` lists what may be said in other words.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice
from pathlib import Path

import pytest

from tests.config.golden import outside
from tests.config.golden.cases import PROGRAM, Case
from tests.config.golden.fixture import (
    Difference,
    Golden,
    Recorded,
    accepted,
    checksum_of,
    differences,
    in_common_words,
    in_words_of_now,
    listed,
    of_run,
    recorded,
    without_other_goals,
)
from tests.config.golden.make import every_case

SHARES = 26
MOST_CHARACTERS = 1500
"""Of a file that is shown."""
MOST_SHOWN = 12
"""Cases that a failed test tells about."""


@pytest.fixture(autouse=True)
def _nothing_starts(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.setenv("COLUMNS", "80")
    with outside.nothing_starts():
        yield


def told(case: Case, changes: list[str]) -> str:
    """Return what a user does and what is other than before."""
    texts = [
        f"--- {name}\n{str(text)[:MOST_CHARACTERS]}"
        for name, text in case.files.items()
        if text != PROGRAM
    ]
    if case.defaults:
        texts.append(f"--- config.toml\n{case.defaults}")
    return "\n".join(
        [f"== {case.name}: {' '.join(case.words)} {case.choices or ''}", *texts, *changes]
    )


@pytest.mark.quick_cases("0")
@pytest.mark.parametrize("share", range(SHARES))
def test_settings_give_what_they_gave(share: int, tmp_path: Path) -> None:
    golden = Golden.read()
    wrong: list[str] = []
    for number, case in enumerate(islice(every_case(), share, None, SHARES)):
        folder = tmp_path / str(number)
        folder.mkdir()
        before = without_other_goals(in_words_of_now(golden.outcomes[case.name]), case)
        now = without_other_goals(in_common_words(recorded(case, folder, golden.plain)), case)
        if case.name in listed("other_first"):
            before["err"] = now["err"]
        if case.name in listed("other_world"):
            before["runs"] = now["runs"]
        if case.name in listed("no_error"):
            assert (before["code"], now["code"]) == (2, 0)
            before = now
        if changes := differences(before, now):
            wrong.append(told(case, changes))
    if wrong:
        shown = "\n".join(wrong[:MOST_SHOWN])
        meant = (
            "If that is meant, say why in a [[difference]] of tests/config/golden/differences.toml."
        )
        pytest.fail(
            f"{len(wrong)} cases give something else than before:\n{shown}\n{meant}", pytrace=False
        )


def test_the_cases_are_those_of_the_golden_file() -> None:
    cases = list(every_case())
    golden = Golden.read()
    assert [case.name for case in cases] == list(golden.outcomes)
    assert checksum_of(cases) == golden.inputs, "what makes up the cases has changed"


def test_there_are_as_many_specifications_and_errors_as_promised() -> None:
    outcomes = Golden.read().outcomes
    assert (
        sum(
            "runs" in outcome for name, outcome in outcomes.items() if not name.startswith("broken")
        )
        >= 9000
    )
    assert (
        sum(
            bool(outcome.get("err"))
            for name, outcome in outcomes.items()
            if name.startswith("broken")
        )
        >= 2000
    )


def test_every_difference_in_wording_is_needed() -> None:
    texts = [
        outcome[key]
        for outcome in Golden.read().outcomes.values()
        for key in ("out", "err")
        if key in outcome
    ]
    unused = []
    for one in accepted():
        # As they are after the differences above it.
        before, texts = texts, [one.applied(text) for text in texts]
        unused += [one.before] if texts == before else []
    assert unused == []
    assert all(one.why for one in accepted())


def test_a_changed_value_is_shown_with_what_it_was(tmp_path: Path) -> None:
    golden = Golden.read()
    now = recorded(Case("x", ("run", "p.py", "-N", "7"), {"p.py": PROGRAM}), tmp_path, golden.plain)
    before = recorded(
        Case("x", ("run", "p.py", "-M", "7"), {"p.py": PROGRAM}), tmp_path, golden.plain
    )
    assert differences(before, before) == []
    assert sorted(line for line in differences(before, now) if "sum" not in line) == [
        "runs.0.set.world.noise.light: 0, as usual → 7",
        "runs.0.set.world.noise.motor: 7 → 0, as usual",
    ]


def test_the_order_of_keys_and_the_form_of_numbers_count(monkeypatch: pytest.MonkeyPatch) -> None:
    def spec(**noise: object) -> dict[str, object]:
        return {"spec": {"world": {"noise": noise}}}

    monkeypatch.setattr(outside, "read_back", lambda plain: plain)

    plain = {"world.noise.light": 0, "world.noise.motor": 0}
    usual = of_run(spec(light=0, motor=0), plain)
    assert usual["set"] == {}
    assert of_run(spec(motor=0, light=0), plain)["sum"] != usual["sum"]
    assert of_run(spec(light=0.0, motor=0), plain)["set"] == {"world.noise.light": 0.0}
    assert of_run(spec(light=False, motor=0), plain)["set"] == {"world.noise.light": False}
    assert of_run(spec(light=0), plain)["gone"] == ["world.noise.motor"]


def test_a_specification_that_is_read_back_as_another_one_is_told(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(outside, "read_back", lambda plain: {**plain, "seed": 1})
    assert of_run({"spec": {"seed": 0}}, {"seed": 0})["is read back as another one"]


def test_an_error_of_before_may_be_said_in_listed_words_only() -> None:
    said: Recorded = {"code": 2, "err": "tuisim: left.red% is no name\n"}
    literal = Difference("left.red%", "left_red_pc", "as it is typed")
    pattern = Difference(r"(\w+)\.red%", r"\1_red_pc", "as it is typed", pattern=True)
    for one in (literal, pattern):
        assert one.applied(said["err"]) == "tuisim: left_red_pc is no name\n"
    assert differences(said, {**said, "err": "tuisim: no\n"}) == [
        "err: 'tuisim: left.red% is no name\\n' → 'tuisim: no\\n'"
    ]
