"""Values in few digits."""

from __future__ import annotations

import pytest

from tuisim.app.snapshot import short_value


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("16.0784313725", "16.08"),
        ("100.0", "100.0"),
        ("[1.23456789, 2]", "[1.235, 2]"),
        ("12345.678901", "12345.7"),
        ("1.2345678e-07", "1.235e-07"),
        ("'v 1.23456789'", "'v 1.23456789'"),
    ],
)
def test_numbers_of_many_decimals_get_four_digits(text: str, expected: str) -> None:
    assert short_value(text) == expected
