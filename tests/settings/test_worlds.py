"""World files that build on others."""

from __future__ import annotations

from pathlib import Path

from tuisim.settings.worlds import load_world


def test_a_world_inherits_program_and_inputs_from_the_world_that_it_names(tmp_path: Path) -> None:
    base, lab, own = (tmp_path / f"{name}.toml" for name in ("base", "lab", "own"))
    base.write_text("program = 'a.py'\ninputs = ['Ada']\n")
    lab.write_text("world = 'base.toml'\nbackground = 'Loop'\n")
    own.write_text("world = 'base.toml'\nprogram = 'b.py'\n")
    above = load_world(str(lab))
    assert above.program == load_world(str(base)).program is not None
    assert above.inputs == ("Ada",)
    assert Path(load_world(str(own)).program or "").name == "b.py"
