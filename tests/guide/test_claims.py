"""What README, guide and lessons claim with a number is what a run shows: `claims/PAGE.toml` says how each is held.

A claim names its sentences (`says`) and what holds them: a `program` (saved as `claim.py`), `files`, `commands` and
Python that looks at what they wrote (`after`). Their output must have what `prints` says (regular expressions);
commands end with 0, or with `exit_codes`. Or it names the test that looks at it (`tested_by`), or says why there is
nothing to run (`because`). A sentence with a number that no claim names is a fault, and so is a claim whose sentence
has gone. The blocks of a page that begin with the name of a file are there as files. For a lesson there are
`world.toml`, `program.py` and `STEP.py`, its model answers, and a program runs in its world.
"""

from __future__ import annotations

import re
import shlex
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.cases import for_each
from tests.conftest import ROOT, Command
from tests.guide.documents import DOCUMENTS, blocks
from tuisim.guide.catalogue import load_pages
from tuisim.tasks.lessons.catalogue import find_shipped_paths
from tuisim.tasks.lessons.files import load_lesson
from tuisim.tasks.lessons.spec import Lesson

LESSONS = {name: load_lesson(path) for name, path in find_shipped_paths().items()}
TEXTS = {"README": DOCUMENTS["README"]} | {name: page.source for name, page in load_pages().items()}
"""README and the pages as they are written: tables made from the code are true by their making."""
KEYS = {
    "says",
    "program",
    "files",
    "commands",
    "after",
    "prints",
    "exit_codes",
    "tested_by",
    "because",
    "slow",
}
_FENCE = re.compile(r"^```.*?^```$", re.MULTILINE | re.DOTALL)
_QUOTED = re.compile(r"`[^`]*`|\]\([^)]*\)|“[^”]*”")
_NUMBER = re.compile(r"(?<![\w.-])\d|[½¼]")
_CODE_IN_HINTS = re.compile(r"\w\(|[a-z_]{2,} = |\w:$|^[\d ./()√=]+$")
_ORDINAL = re.compile(r"^(#+ )?\d+\. ")


def _claims() -> dict[str, list[dict[str, Any]]]:
    folder = Path(__file__).parent / "claims"
    return {
        path.stem: tomllib.loads(path.read_text(encoding="utf-8"))["claim"]
        for path in sorted(folder.glob("*.toml"))
    }


CLAIMS = _claims()


def _plain(text: str) -> str:
    return " ".join(text.split())


def _parts_of(lesson: Lesson) -> Iterator[str]:
    """What a student reads in a lesson, except what a task asks for: the conditions of its goals say that."""
    yield lesson.path.read_text(encoding="utf-8").split("+++")[2]
    yield lesson.why
    for step in lesson.steps:
        yield from (step.why, *step.hints)
    for goal in lesson.goals:
        yield goal.hint


def _paragraphs(name: str) -> list[str]:
    text = "\n\n".join(_parts_of(LESSONS[name])) if name in LESSONS else TEXTS[name]
    text = re.sub(r"<!-- table.*?-->", "", _FENCE.sub("\n\n", text))
    return [_plain(part) for part in re.split(r"\n\s*\n|\n(?=[|#-]|\d+\. )", text) if part.strip()]


def _sentences(name: str) -> Iterator[str]:
    """The sentences and the rows of tables that have a number outside of code."""
    for paragraph in _paragraphs(name):
        whole = paragraph.startswith("|")
        paragraph = _ORDINAL.sub("", paragraph)
        for sentence in [paragraph] if whole else re.split(r"(?<=[.!?]) (?=[A-Z`*\[(])", paragraph):
            is_code = name in LESSONS and _CODE_IN_HINTS.search(sentence)
            if not is_code and _NUMBER.search(_QUOTED.sub("", sentence)):
                yield sentence


def _says(claim: dict[str, Any]) -> list[str]:
    said = claim["says"]
    return [_plain(one) for one in ([said] if isinstance(said, str) else said)]


@for_each(name=[*TEXTS, *LESSONS])
def test_each_sentence_of_the_guide_with_a_number_has_a_claim(name: str) -> None:
    said = [one for claim in CLAIMS.get(name, []) for one in _says(claim)]
    assert [
        sentence for sentence in _sentences(name) if not any(one in sentence for one in said)
    ] == []


@for_each(name=CLAIMS)
def test_each_claims_sentence_is_in_its_page_and_its_test_exists(name: str) -> None:
    text = "\n".join(_paragraphs(name))
    for claim in CLAIMS[name]:
        assert set(claim) <= KEYS
        assert [one for one in _says(claim) if one not in text] == []
        assert sum(key in claim for key in ("prints", "tested_by", "because")) == 1, claim["says"]
        file, _, test = claim.get("tested_by", "").partition("::")
        assert f"def {test}(" in (ROOT / file).read_text(encoding="utf-8") if file else True, claim[
            "tested_by"
        ]


def _cases() -> Iterator[Any]:
    """A case for each claim that is run; one of each page is quick."""
    for name, claims in CLAIMS.items():
        has_quick = False
        for count, claim in enumerate(claims, 1):
            if "prints" in claim:
                marks = [pytest.mark.slow] if claim.get("slow") or has_quick else []
                has_quick = has_quick or not marks
                yield pytest.param(name, claim, id=f"{name} {count}", marks=marks)


def _lay_out(name: str, where: Path) -> None:
    """Write the files of a page, or the world of a lesson, its program and its model answers."""
    if lesson := LESSONS.get(name):
        front = lesson.path.read_text(encoding="utf-8").split("+++")[1]
        if told := re.search(r'^tells = "(.+)"$', front, re.MULTILINE):
            front = (lesson.path.parent / told[1]).read_text(encoding="utf-8").split("+++")[1]
            profile = f'profile = "{lesson.settings["profile"]}"'
            front = re.sub(r"^profile = .*$", profile, front, flags=re.MULTILINE)
        world = front.partition("[[step]]")[0]
        (where / "world.toml").write_text(
            re.sub(r"^(why|minutes) = .*$", "", world, flags=re.MULTILINE)
        )
        (where / "program.py").write_text(lesson.program)
        for step in lesson.steps:
            (where / f"{step.name}.py").write_text(step.answer)
    else:
        for block in blocks(name):
            if block.file:
                (where / block.file).write_text(block.code)


@pytest.mark.parametrize("name, claim", [*_cases()])
def test_commands_and_programs_print_what_the_guide_claims(
    name: str,
    claim: dict[str, Any],
    tmp_path: Path,
    here: Command,
    home: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    _lay_out(name, tmp_path)
    for file, text in {**claim.get("files", {}), "claim.py": claim.get("program", "")}.items():
        (tmp_path / file).parent.mkdir(exist_ok=True)
        (tmp_path / file).write_text(text)
    commands = claim.get(
        "commands", ["run world.toml claim.py" if name in LESSONS else "run claim.py"]
    )
    done = [here(*shlex.split(command)) for command in commands]
    exec(claim.get("after", ""), {})
    output = "\n".join([*(one.stdout + one.stderr for one in done), capsys.readouterr().out])
    assert [one.returncode for one in done] == claim.get("exit_codes", [0] * len(done)), output
    prints = [claim["prints"]] if isinstance(claim["prints"], str) else claim["prints"]
    assert [one for one in prints if not re.search(one, output, re.MULTILINE)] == [], output
