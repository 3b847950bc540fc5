"""Marked places on a picture: labels that would cover each other stand above and below their rings."""

from __future__ import annotations

import re

from tuisim.analysis.pins import Pin, svg_of_pins
from tuisim.core.spec import RobotSpec
from tuisim.scene.pictures import world_view


def _labels(*pins: Pin) -> list[tuple[float, str]]:
    drawn = svg_of_pins(pins, world_view(RobotSpec()))
    found = re.findall(r'cy="([\d.]+)".*?<text x="[\d.]+" y="([\d.]+)".*?>(.*?)</text>', drawn)
    return [(float(y) - float(ring), re.sub("<.*?>", "", text)) for ring, y, text in found]


def test_a_label_that_another_one_would_cover_stands_below() -> None:
    pins = [
        Pin("1", 900, 500, True, ""),
        Pin("2", 960, 500, False, ""),
        Pin("3", 1600, 500, True, ""),
    ]
    assert [(way > 0, text) for way, text in _labels(*pins)] == [
        (False, "✓1"),
        (True, "✗2"),
        (False, "✓3"),
    ]


def test_places_that_are_one_share_a_ring() -> None:
    pins = [Pin("1", 900, 500, True, ""), Pin("2", 902, 501, False, "")]
    assert [text for _, text in _labels(*pins)] == ["✓1 ✗2"]
    assert svg_of_pins([], world_view(RobotSpec())) == ""
