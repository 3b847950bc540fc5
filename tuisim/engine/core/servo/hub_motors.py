"""The motors of the hubs: what they are, and what the firmware lets them do.

Source: Pybricks 4.1, `lib/pbio/src/motor/servo_settings.c`. Imported on demand: only programs for a hub need it.
"""

from __future__ import annotations

from collections.abc import Mapping

from tuisim.base.data_class import dataclass
from tuisim.engine.core.driver.plant import PlantSpec


@dataclass(frozen=True, slots=True)
class HubMotor:
    """One kind of motor."""

    speed_dps: int
    """The highest speed."""
    tolerance_deg: int
    torque_unm: int
    """The highest torque, in micro-Nm."""
    gains: tuple[int, int, int]
    """kp, ki and kd, in micro-Nm per degree (and second)."""
    plant: PlantSpec
    max_voltage_mv: int = 9000


def _build_plant(
    resistance_ohm: float, torque: float, back_emf: float, inertia: float, friction_mnm: float
) -> PlantSpec:
    friction_nm = friction_mnm / 1000
    return PlantSpec(
        resistance_ohm, back_emf, torque, inertia * 1e-6, 1e-7, friction_nm, friction_nm
    )


MOTORS: Mapping[str, HubMotor] = {
    "large-angular": HubMotor(
        1000, 11, 560_795, (42_484, 21_242, 5310), _build_plant(3.73, 0.232, 0.411, 1219, 23.2)
    ),
    "medium-angular": HubMotor(
        1000, 11, 199_554, (15_117, 7558, 1889), _build_plant(10.73, 0.238, 0.376, 301, 21.4)
    ),
    "small-angular": HubMotor(
        620, 11, 62_415, (5674, 2837, 709), _build_plant(17.65, 0.184, 0.385, 139, 9.2), 6000
    ),
    "interactive": HubMotor(
        1200, 12, 135_083, (9380, 4690, 1172), _build_plant(18.24, 0.274, 0.309, 237, 11.2)
    ),
    "technic": HubMotor(
        1500, 20, 263_601, (10_983, 5491, 1372), _build_plant(7.52, 0.220, 0.245, 453, 26.4)
    ),
}
"""By `MotorSpec.kind`."""
