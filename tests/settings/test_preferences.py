"""What the user has chosen in the app is found again."""

from __future__ import annotations

from pathlib import Path

import pytest

from tuisim.app.editor.text_file import keep_draft, list_drafts
from tuisim.settings.preferences import find_preferences_file, get_preference, keep


@pytest.fixture(autouse=True)
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TUISIM_HOME", str(tmp_path / "home"))


def test_a_stored_preference_is_found_and_leaves_the_others() -> None:
    keep("cells", "octant")
    keep("theme", "light")
    keep("cells", None)

    assert (get_preference("cells"), get_preference("theme")) == (None, "light")


def test_an_app_in_its_own_session_shares_no_preferences_or_drafts_with_others(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    keep("theme", "light")
    keep_draft("", "of another app")
    monkeypatch.setenv("TUISIM_SESSION", str(tmp_path / "session"))
    assert (get_preference("theme"), list_drafts()) == (None, [])
    keep("theme", "dark")
    keep_draft("", "of this one")
    monkeypatch.delenv("TUISIM_SESSION")
    assert (get_preference("theme"), list_drafts()[0].text) == ("light", "of another app")


@pytest.mark.parametrize(
    "text", ["", "{", "[1]", "\udc80"], ids=["empty", "cut off", "a list", "no UTF-8"]
)
def test_a_damaged_file_of_preferences_counts_as_empty(text: str) -> None:
    find_preferences_file().parent.mkdir()
    find_preferences_file().write_bytes(text.encode("utf-8", "surrogateescape"))

    assert get_preference("cells") is None
    keep("cells", "half")
    assert get_preference("cells") == "half"
