"""The electric motors of the hubs.

Source: Pybricks 4.1, `lib/pbio/src/motor/servo_settings.c`. Imported on demand: only programs for a hub need it.
"""

from __future__ import annotations

from collections.abc import Mapping

from tuisim.engine.core.driver.plant import PlantSpec

PLANTS: Mapping[str, PlantSpec] = {
    "large-angular": PlantSpec(3.73, 0.411, 0.232, 1219e-6, 1e-7, 0.0232, 0.0232),
    "medium-angular": PlantSpec(10.73, 0.376, 0.238, 301e-6, 1e-7, 0.0214, 0.0214),
    "small-angular": PlantSpec(17.65, 0.385, 0.184, 139e-6, 1e-7, 0.0092, 0.0092),
    "interactive": PlantSpec(18.24, 0.309, 0.274, 237e-6, 1e-7, 0.0112, 0.0112),
    "technic": PlantSpec(7.52, 0.245, 0.220, 453e-6, 1e-7, 0.0264, 0.0264),
}
"""The motors of hubs, by `MotorSpec.kind`."""
