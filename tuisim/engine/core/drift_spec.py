"""The sizes of all drift errors: 0 by default, each with a typical size and the source of that size."""

from __future__ import annotations

from typing import Any

from tuisim.engine.core.spec_fields import Spec, named_number, spec


def _build_field(high: float, typical: float, unit: str, about: str, source: str) -> Any:
    names = {"typical": typical}
    return named_number(
        0, high, names, default=0.0, later=True, unit=unit, help=about, source=source
    )


@spec
class DriftSpec(Spec):
    """Sizes of the errors of wheels and sensors that programs do not expect.

    The motors' encoders do not show these errors.
    """

    KEY = "drift"

    wheel_pc: float = _build_field(
        10,
        0.5,
        "%",
        "standard deviation of each wheel's diameter from the robot's, drawn once per run",
        "the manual of LEGO's MicroPython takes 55.5 mm for a tyre that is sold as 56 mm: 0.9 % less",
    )
    spacing_pc: float = _build_field(
        10,
        1.0,
        "%",
        "standard deviation of the distance of the wheels from the robot's, drawn once per run",
        "Borenstein & Feng, Measurement and Correction of Systematic Odometry Errors in Mobile Robots (1996): tyres "
        "touch the floor in an area, which leaves the effective distance uncertain by about 1 %",
    )
    slip_pc: float = _build_field(
        50,
        1.0,
        "%",
        "mean slip of a wheel that accelerates by 1 m/s²; in proportion at other accelerations",
        "a rubber tyre slips by its force / (10 to 30 × its load) as long as it grips (Pacejka, Tyre and Vehicle "
        "Dynamics): a tenth of the load, at 1 m/s², is 1 % of a soft tyre",
    )
    turn_slip_pc: float = _build_field(
        50,
        1.0,
        "%",
        "mean slip of the part of a wheel's distance that turns the robot",
        "the same law: a castor with a third of the weight and a friction of 0.2 holds each wheel back with about "
        "a tenth of its load",
    )
    backlash_deg: float = _build_field(
        90,
        3.0,
        "°",
        "backlash between a motor and its wheel: how far the motor turns after a reversal before the wheel turns",
        "an estimate, as LEGO publishes none: about three counts of the encoder",
    )
    gyro_dps: float = _build_field(
        20,
        0.05,
        "°/s",
        "standard deviation of the gyro's rate while the robot stands, drawn once per run",
        "LEGO states an accuracy of ±3° for the EV3 gyro: this is 3° in a minute",
    )
    gyro_scale_pc: float = _build_field(
        20,
        2.0,
        "%",
        "how much too little the gyro counts of a clockwise turn",
        "40 measurements on a turntable (EV3 Basic): 353° of 360° clockwise in 5 s, 361° counter-clockwise",
    )
    echo_bias_mm: float = _build_field(
        100,
        14.0,
        "mm",
        "largest error of an ultrasonic sensor's distances, drawn once per run from -1/7 of it up to it",
        "measured at 5, 10, 15, 20, 25 and 30 cm: 5.0, 11.4, 14.8, 20.4, 25.4 and 31.4 "
        "(eriymirsai, 2022; the sensor is not named)",
    )
    echo_loss_pc: float = _build_field(
        100,
        100.0,
        "%",
        "share of the ultrasonic pulses without echo at the flattest angle of 50° off the normal of a "
        "surface; none up to 15°, in proportion between",
        "data sheet of the HC-SR04: effective up to 15°; the simulator's own limit is 50°",
    )
    light_pc: float = _build_field(
        90,
        10.0,
        "%",
        "how much darker one side of the field is than the opposite side; the direction is random",
        "EN 12464-1 lets the darkest place of a classroom have 60 % of the mean light; the sensor's own lamp, close "
        "to the mat, outshines most of that: a quarter of 40 %",
    )
    light_gain_pc: float = _build_field(
        30,
        5.0,
        "%",
        "standard deviation of each colour sensor's brightness from the robot's, drawn once per run",
        "an estimate, as nobody publishes it: sold line followers calibrate each sensor by itself "
        "(redrobots.xyz, 2019)",
    )

    @property
    def is_none(self) -> bool:
        """Whether all drift errors in this spec are 0."""
        return self is NO_DRIFT or not any(self._list_contents())


NO_DRIFT = DriftSpec()
