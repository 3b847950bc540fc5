"""World files that build on others."""

from __future__ import annotations

from pathlib import Path

from tuisim.settings.worlds import WorldFile


def test_a_world_inherits_program_and_inputs_from_the_world_that_it_names(tmp_path: Path) -> None:
    base, lab, own = (tmp_path / f"{name}.toml" for name in ("base", "lab", "own"))
    base.write_text("program = 'a.py'\ninputs = ['Ada']\n")
    lab.write_text("world = 'base.toml'\nbackground = 'Loop'\n")
    own.write_text("world = 'base.toml'\nprogram = 'b.py'\n")
    above = WorldFile.load(str(lab))
    assert above.program == WorldFile.load(str(base)).program is not None
    assert above.inputs == ("Ada",)
    assert Path(WorldFile.load(str(own)).program or "").name == "b.py"
