"""What is read beside a program: its own modules."""

from __future__ import annotations

import os
from pathlib import Path

from tuisim.base.source import Program
from tuisim.programs.program_settings import read_source_facts
from tuisim.programs.robot.source import read_modules


def test_a_programs_own_modules_are_read_from_packages_and_subfolders(tmp_path: Path) -> None:
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
    facts = read_source_facts(Program("main.py", text, path=str(tmp_path / "main.py")))
    assert facts.library is not None and facts.robot is not None
    assert [part.what for part in facts.robot.parts if part.changes] == ["medium motor on outA"]
    assert str(facts.robot.parts[-1].where) == "parts/deep/arm.py, line 4"


def test_importing_a_module_with_too_long_a_path_is_ignored_when_reading_a_program() -> None:
    for name in ("a" * 300, ".".join(["a" * 200] * 20), ".".join("a" * 3000)):
        assert [*read_modules(Program("main.py", f"import {name}\n"))] == [""], name
