"""The text of a new program: it runs as it is, on the mat that was chosen."""

from __future__ import annotations

from tests.cases import for_each
from tests.running import Run
from tuisim.app.dialogs.new_program import READINGS, Skeleton, build_program_text
from tuisim.programs.program_file import parse_program


@for_each(skeleton=Skeleton, sensor=READINGS)
def test_each_new_program_text_compiles_and_names_its_mat(sensor: str, skeleton: Skeleton) -> None:
    source = parse_program(build_program_text("my mats/a b.png", sensor, skeleton), "new.py")
    compile(source.program.text, "new.py", "exec")
    assert source.options["background"] == "my mats/a b.png"
    brings_library = skeleton in (Skeleton.LIBRARY, Skeleton.PYBRICKS, Skeleton.PRIME_HUB)
    assert source.program.prelude == ("none" if brings_library else "preloaded")


def test_the_default_new_program_runs_and_logs_60_light_samples(run: Run) -> None:
    source = parse_program(build_program_text("Grey_bands", "colorLeft", Skeleton.LOG), "new.py")
    done = run(source.program.text, prelude=source.program.prelude, background="Grey_bands")
    assert len(done.lines) == 60
    assert all(line.startswith("Light: ") for line in done.lines)
