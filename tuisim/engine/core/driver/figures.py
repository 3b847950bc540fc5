"""All constants of motors with a driver, each with its source."""

from __future__ import annotations

from typing import NamedTuple

from tuisim.engine.core.driver.control import SPEED_CONSTANTS
from tuisim.engine.core.driver.jiffies import JIFFY_US
from tuisim.engine.core.driver.motor import LOOK_NS
from tuisim.engine.core.driver.plant import STEP_NS
from tuisim.engine.core.driver.regulator import MODELS, STALL_NS
from tuisim.engine.core.driver.simulated import ROLLING_SHARE, WHEEL_KG

_LARGE = "large: nxt-unroller (2015), by rolling out, load and start"
_MEDIUM = "medium: two points under load by Philo"
_MEASURED = f"{_LARGE}; {_MEDIUM}"
_GUESS = "medium: an estimate"
_DRIVER = "the EV3 driver of kernel 4.14"
PLANT_SOURCES = {
    "resistance_ohm": f"{_MEASURED}; with bridge and battery",
    "back_emf_v_s": _MEASURED,
    "torque_nm_per_a": _MEASURED,
    "inertia_kg_m2": f"{_LARGE}; {_GUESS}",
    "damping_nm_s": _MEASURED,
    "friction_nm": "large: the duty cycle below which free motors do not move, from logs in five public repositories; "
    f"{_MEDIUM}",
    "breakaway_nm": f"large: a free motor in the logs of Lab_1 starts at 6 to 7 % of duty; {_GUESS}",
}
"""Source of each constant, by the fields of `PlantSpec`."""


class Figure(NamedTuple):
    """A constant of the EV3 motors, with its values for the large and the medium motor and their source."""

    name: str
    large: float
    medium: float
    source: str


def list_figures() -> list[Figure]:
    """Return all constants of simulated EV3 motors: of the motor, of its load, and of its driver."""
    large = MODELS["large"]
    medium = MODELS["medium"]
    common = {
        "wheel_kg": (WHEEL_KG, "a wheel and tyre of 56 mm, taken for a disc: an estimate"),
        "rolling_share": (
            ROLLING_SHARE,
            "friction of a wheel, as a share of its load: an estimate",
        ),
        **{
            f"speed_{name}": (value, _DRIVER)
            for name, value in zip(("kp", "ki", "kd"), SPEED_CONSTANTS, strict=True)
        },
        "control_ms": (STEP_NS / 1e6, _DRIVER),
        "stall_ms": (STALL_NS / 1e6, _DRIVER),
        "look_ms": (LOOK_NS / 1e6, f"{_DRIVER}: how often it reports a new state"),
        "jiffy_ms": (JIFFY_US / 1000, "the configuration of that kernel: 100 Hz"),
    }
    return [
        *(
            Figure(name, getattr(large.plant, name), getattr(medium.plant, name), source)
            for name, source in PLANT_SOURCES.items()
        ),
        Figure("max_speed_dps", large.max_speed_dps, medium.max_speed_dps, _DRIVER),
        Figure("hold_kp", large.hold_kp, medium.hold_kp, _DRIVER),
        *(Figure(name, value, value, source) for name, (value, source) in common.items()),
    ]
