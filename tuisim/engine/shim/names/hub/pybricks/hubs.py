"""The hubs."""

from tuisim.engine.shim.pybricks.hub.hubs import (
    CityHub,
    EssentialHub,
    MoveHub,
    PrimeHub,
    TechnicHub,
)

InventorHub = ThisHub = PrimeHub
