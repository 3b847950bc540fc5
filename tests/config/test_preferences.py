"""What the user has chosen in the app is found again."""

from __future__ import annotations

from pathlib import Path

import pytest

from tuisim.config.preferences import keep, preference, preferences_file


@pytest.fixture(autouse=True)
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TUISIM_HOME", str(tmp_path / "home"))


def test_what_is_kept_is_found_and_leaves_the_rest() -> None:
    keep("cells", "octant")
    keep("theme", "light")
    keep("cells", None)

    assert (preference("cells"), preference("theme")) == (None, "light")


@pytest.mark.parametrize(
    "text", ["", "{", "[1]", "\udc80"], ids=["empty", "cut off", "a list", "no UTF-8"]
)
def test_a_damaged_file_is_an_empty_one(text: str) -> None:
    preferences_file().parent.mkdir()
    preferences_file().write_bytes(text.encode("utf-8", "surrogateescape"))

    assert preference("cells") is None
    keep("cells", "half")
    assert preference("cells") == "half"
