"""Robots, worlds and what belongs to them, made up by hypothesis."""

from __future__ import annotations

from hypothesis import strategies as st

from tuisim.engine.core.css_colors import load_css_colors
from tuisim.engine.core.hub_spec import EV3_MOTORS
from tuisim.engine.core.remote_spec import RemotePress
from tuisim.engine.core.spec import (
    INPUT_PORTS,
    MOTOR_ENDS,
    OUTPUT_PORTS,
    STRATEGIES,
    ColorSensorSpec,
    GyroSpec,
    InfraredSpec,
    MotorSpec,
    Obstacle,
    PenSpec,
    RobotSpec,
    TouchSpec,
    UltrasonicSpec,
)


def mm(low: float, high: float) -> st.SearchStrategy[float]:
    return st.floats(low, high, allow_nan=False)


places = mm(-500, 500)
names = st.text(min_size=1, max_size=30).filter(
    lambda name: name.isprintable() and name.strip() != ""
)
pens = st.builds(
    PenSpec,
    x_mm=places,
    y_mm=places,
    color=st.sampled_from(sorted(load_css_colors())) | st.just("#0a1b2c"),
    width_mm=mm(0.1, 200),
    down=st.booleans(),
)
boxes = st.builds(Obstacle, mm(-1e4, 1e4), mm(-1e4, 1e4), mm(1e-9, 1e4), mm(1e-9, 1e4))


presses = st.builds(
    RemotePress,
    st.sampled_from([("beacon",), ("top_left",), ("top_left", "bottom_right")]),
    mm(0, 10),
    mm(10, 1e9),
    st.integers(1, 4),
)


def further_motors(port: str) -> st.SearchStrategy[MotorSpec]:
    """Motors on a port with both end stops, one or none."""
    kinds = st.sampled_from(EV3_MOTORS)
    low = st.none() | mm(-1e5, -5)
    high = st.none() | mm(0, 1e5)
    return st.builds(MotorSpec, st.just(port), kinds, low, high)


@st.composite
def robots(draw: st.DrawFn) -> RobotSpec:
    """Robots of every make: with and without each sensor, on any ports, colour sensors in any order."""
    ports = draw(st.permutations(INPUT_PORTS))
    sensor_names = draw(
        st.lists(st.sampled_from(["left", "right", "middle", "A_1"]), unique=True, max_size=2)
    )
    colors = tuple(
        ColorSensorSpec(
            name,
            port,
            draw(places),
            draw(places),
            draw(st.integers(2, 100)),
            draw(st.sampled_from(STRATEGIES)),
        )
        for name, port in zip(sensor_names, ports, strict=False)
    )
    ultrasonic = st.builds(
        UltrasonicSpec,
        port=st.just(ports[2]),
        x_mm=places,
        y_mm=places,
        angle_deg=mm(-360, 360),
        max_range_mm=mm(1, 1e4),
        noise_mm=mm(0, 1000),
        ray_angles_deg=st.lists(mm(-360, 360), min_size=1, max_size=5).map(tuple),
    )
    left, right, *free = draw(st.permutations(OUTPUT_PORTS))
    motors = [
        draw(further_motors(port))
        for port in draw(st.lists(st.sampled_from(free), unique=True, max_size=2))
    ]
    spare = ports[len(colors) : 2]
    further = draw(st.sampled_from(["touch", "ultrasonic", "none"])) if spare else "none"
    ends = [
        (motor.port, end)
        for motor in motors
        for end in MOTOR_ENDS
        if getattr(motor, f"{end}_deg") is not None
    ]
    presser = draw(st.sampled_from([("", "low"), *ends]))
    touch = st.builds(
        TouchSpec,
        st.just("bumper"),
        st.sampled_from(spare or ["in1"]),
        places,
        places,
        mm(1, 500),
        *map(st.just, presser),
    )
    second = st.builds(
        UltrasonicSpec, st.just("back"), st.sampled_from(spare or ["in1"]), places, places
    )
    infrared = st.builds(
        InfraredSpec, port=st.just(ports[3]), x_mm=places, y_mm=places, angle_deg=mm(-360, 360)
    )
    at_last = draw(st.sampled_from(["gyro", "infrared", "none"]))
    return RobotSpec(
        name=draw(names),
        wheel_diameter_mm=draw(mm(1, 500)),
        wheel_spacing_mm=draw(mm(1, 1000)),
        wheel_width_mm=draw(mm(1, 200)),
        back_mm=draw(mm(-1000, 0)),
        weight=draw(st.sampled_from([0.0, 3.0, 6.0, 9.0]) | mm(0, 1000)),
        left_port=left,
        right_port=right,
        color_sensors=colors,
        ultrasonic=draw(st.none() | ultrasonic),
        gyro=GyroSpec(port=ports[3]) if at_last == "gyro" else None,
        pen=draw(pens),
        extra_motors=tuple(motors),
        extra_ultrasonics=(draw(second),) if further == "ultrasonic" else (),
        touch_sensors=(draw(touch),) if further == "touch" else (),
        infrared=draw(infrared) if at_last == "infrared" else None,
        left_reversed=draw(st.booleans()),
        right_reversed=draw(st.booleans()),
        gear_ratio=draw(st.just(1.0) | mm(0.01, 100)),
    )
