"""Where further sensors sit."""

from __future__ import annotations

from tests.config.program_robot.reading import built


def test_bumpers_reach_to_the_corners_of_the_robot() -> None:
    found = built(
        "MoveDifferential(OUTPUT_B, OUTPUT_C, EV3Tire, 130)\nl, r = TouchSensor('in1'), TouchSensor('in4')"
    )
    assert found is not None
    robot = found.choice.spec
    reach = [
        (touch.x_mm - touch.width_mm / 2, touch.x_mm + touch.width_mm / 2)
        for touch in robot.touch_sensors
    ]
    half_mm = (130 + robot.wheel_width_mm) / 2
    assert reach == [(-half_mm, 0), (0, half_mm)]
