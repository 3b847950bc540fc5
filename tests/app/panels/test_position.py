"""Numbers in the position panel."""

from __future__ import annotations

import pytest

from tuisim.app.panels.position import parse_field


@pytest.mark.parametrize("text", ["1", " -2.5 ", "3,5", "+4e2"])
def test_numbers_that_may_be_typed(text: str) -> None:
    assert parse_field("x", text) == float(text.replace(",", "."))
