"""What is read beside a program: its own modules, and files of values."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from tests.programs.robot.reading import HEAD
from tuisim.base.source import Program
from tuisim.programs.program_settings import facts_of


@pytest.mark.parametrize(
    "text",
    [
        "with open(os.path.join(HERE, 'ports.json')) as file:\n    ports = json.load(file)",
        "ports = json.loads(Path('ports.json').read_text())",
        "ports = json.load((Path(__file__).parent / 'ports.json').open())",
        "import ujson\nports = ujson.load(open('ports.json'))",
    ],
    ids=["open", "text", "path", "micropython"],
)
def test_a_file_of_values_beside_the_program_is_read(tmp_path: Path, text: str) -> None:
    (tmp_path / "ports.json").write_text('{"arm": ["outD"]}')
    head = f"{HEAD}import json, os\nfrom pathlib import Path\nHERE = os.path.dirname(__file__)\n"
    source = f"{head}{text}\nMediumMotor(ports['arm'][0])"
    robot = facts_of(Program("p.py", source, path=str(tmp_path / "p.py"))).robot
    assert robot is not None
    assert [motor.port for motor in robot.choice.spec.extra_motors] == ["outD"]


@pytest.mark.parametrize(
    "name",
    [
        "../ports.json",
        "link.json",
        "/absolute",
        "none.json",
        "folder",
        "pipe",
        "large.json",
        "deep.json",
        "rubbish.json",
    ],
)
def test_no_other_file_is_read(tmp_path: Path, name: str) -> None:
    folder = tmp_path / "own"
    (folder / "folder").mkdir(parents=True)
    ports = '{"arm": "outD"}'
    (tmp_path / "ports.json").write_text(ports)
    (folder / "link.json").symlink_to(tmp_path / "ports.json")
    os.mkfifo(folder / "pipe")
    (folder / "large.json").write_text(ports + " " * 70_000)
    (folder / "deep.json").write_text("[" * 60_000)
    (folder / "rubbish.json").write_bytes(b"\xff{")
    given = str(tmp_path / "ports.json") if name == "/absolute" else name
    source = f"{HEAD}import json\nports = json.load(open({given!r}))\nMediumMotor(ports['arm'])"
    robot = facts_of(Program("p.py", source, path=str(folder / "p.py"))).robot
    assert robot is None or all(motor.port != "outD" for motor in robot.choice.spec.extra_motors)


def test_modules_of_its_own_are_read_wherever_they_lie(tmp_path: Path) -> None:
    (tmp_path / "parts" / "deep").mkdir(parents=True)
    (tmp_path / "parts" / "__init__.py").write_text("from .deep import arm\n")
    (tmp_path / "parts" / "deep" / "arm.py").write_text(
        "from ev3dev2.motor import MediumMotor\nfrom ..ports import ARM\nimport main\nmotor = MediumMotor(ARM)\n"
        "if __name__ == '__main__':\n    MediumMotor('outD')\n"
    )
    (tmp_path / "parts" / "ports.py").write_text("ARM = 'outA'\n")
    (tmp_path / "main.py").write_text("import parts\nparts.arm.motor.on(5)\n")
    os.mkfifo(tmp_path / "pipe.py")
    text = (tmp_path / "main.py").read_text() + "import pipe, missing, json\n"
    facts = facts_of(Program("main.py", text, path=str(tmp_path / "main.py")))
    assert facts.library is not None and facts.robot is not None
    assert [part.what for part in facts.robot.parts if part.changes] == ["medium motor on outA"]
    assert str(facts.robot.parts[-1].where) == "parts/deep/arm.py, line 4"
