"""The motors of the hubs, with the limits that the firmware sets for them.

Source: Pybricks 4.1, `lib/pbio/src/motor/servo_settings.c`. Imported on demand: only programs for a hub need it.
"""

from __future__ import annotations

from collections.abc import Mapping

from tuisim.base.data_class import dataclass
from tuisim.engine.core.driver.plant import PlantSpec


@dataclass(frozen=True, slots=True)
class HubMotor:
    """The constants of one kind of motor that hubs have."""

    speed_dps: int
    """The highest speed, in degrees per second."""
    tolerance_deg: int
    torque_unm: int
    """The highest torque, in micro-Nm."""
    gains: tuple[int, int, int]
    """kp, ki and kd, in micro-Nm per degree (and second)."""
    plant: PlantSpec


MOTORS: Mapping[str, HubMotor] = {
    "large-angular": HubMotor(
        1000,
        11,
        560_795,
        (42_484, 21_242, 5310),
        PlantSpec(3.73, 0.411, 0.232, 1219e-6, 1e-7, 0.0232, 0.0232),
    ),
    "medium-angular": HubMotor(
        1000,
        11,
        199_554,
        (15_117, 7558, 1889),
        PlantSpec(10.73, 0.376, 0.238, 301e-6, 1e-7, 0.0214, 0.0214),
    ),
    "small-angular": HubMotor(
        620,
        11,
        62_415,
        (5674, 2837, 709),
        PlantSpec(17.65, 0.385, 0.184, 139e-6, 1e-7, 0.0092, 0.0092),
    ),
    "interactive": HubMotor(
        1200,
        12,
        135_083,
        (9380, 4690, 1172),
        PlantSpec(18.24, 0.309, 0.274, 237e-6, 1e-7, 0.0112, 0.0112),
    ),
    "technic": HubMotor(
        1500,
        20,
        263_601,
        (10_983, 5491, 1372),
        PlantSpec(7.52, 0.245, 0.220, 453e-6, 1e-7, 0.0264, 0.0264),
    ),
}
"""The motors of hubs, by `MotorSpec.kind`."""
