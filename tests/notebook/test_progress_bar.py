"""The bar `tqdma` of a course's cells."""

from __future__ import annotations

import io
import wave

import pytest

from tests.notebook.lesson import execute, stream
from tuisim.notebook.progress_bar import RATE_HZ, build_tone


def test_the_tone_of_a_notebooks_progress_bar_is_a_short_sound() -> None:
    with wave.open(io.BytesIO(build_tone())) as sound:
        assert (sound.getnchannels(), sound.getsampwidth(), sound.getframerate()) == (1, 2, RATE_HZ)
        assert sound.getnframes() / RATE_HZ == 0.4


CELLS = {
    "load": "import tqdm.notebook\nfrom nbev3devsim.load_nbev3devwidget import tqdma",
    "kind": "print(issubclass(tqdma, tqdm.notebook.tqdm))",
    "bar": "print(sum(tqdma(range(4), desc='Rounds')))",
    "hidden": "print(sum(tqdma(range(4), disable=True)))",
}


@pytest.mark.slow
def test_a_notebooks_progress_bar_counts_and_sounds_once_at_its_end(course_kernel: str) -> None:
    done = execute(CELLS, course_kernel)
    assert (stream(done["kind"]), stream(done["bar"]), stream(done["hidden"])) == (
        "True\n",
        "6\n",
        "6\n",
    )
    bundles = [output.data for output in done["bar"].outputs if "data" in output]
    assert ["<audio" in bundle.get("text/html", "") for bundle in bundles] == [False, True]
    assert "application/vnd.jupyter.widget-view+json" in bundles[0]
    assert not [output for output in done["hidden"].outputs if "data" in output]
