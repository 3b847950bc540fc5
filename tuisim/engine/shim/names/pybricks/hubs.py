"""The brick, or the hub."""

from tuisim.engine.shim.pybricks.hub.hubs import (
    CityHub as CityHub,
)
from tuisim.engine.shim.pybricks.hub.hubs import (
    EssentialHub as EssentialHub,
)
from tuisim.engine.shim.pybricks.hub.hubs import (
    MoveHub as MoveHub,
)
from tuisim.engine.shim.pybricks.hub.hubs import (
    PrimeHub as PrimeHub,
)
from tuisim.engine.shim.pybricks.hub.hubs import (
    TechnicHub as TechnicHub,
)
from tuisim.engine.shim.pybricks.hubs import EV3Brick as EV3Brick

InventorHub = PrimeHub
