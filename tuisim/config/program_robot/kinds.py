"""The kinds of motors in programs of Pybricks, whose library has one class for large and medium motors."""

from __future__ import annotations

from collections.abc import Mapping

from tuisim.config.program_robot.library import DeviceKind
from tuisim.config.program_robot.mentions import Mentions
from tuisim.config.program_robot.words import means_large, means_tool
from tuisim.core.profile import Library

_MOST_MEDIUM = 2
"""As many medium motors as robots have beside two large ones."""


def with_tools(kinds: Mapping[str, DeviceKind], mentions: Mentions) -> dict[str, DeviceKind]:
    """Return the kinds of motors by port: also of those whose names say that they move a tool."""
    return _with_medium(
        kinds, mentions, [port for port in kinds if means_tool(_names(port, mentions))]
    )


def with_others(kinds: Mapping[str, DeviceKind], mentions: Mentions) -> dict[str, DeviceKind]:
    """Return the kinds of the motors that drive no wheel, by port."""
    return _with_medium(kinds, mentions, [*kinds])


def _with_medium(
    kinds: Mapping[str, DeviceKind], mentions: Mentions, others: list[str]
) -> dict[str, DeviceKind]:
    """Return kinds with one or two other motors than those of the wheels as medium ones, as in LEGO's sets."""
    if mentions.library is not Library.PYBRICKS or len(others) > _MOST_MEDIUM:
        return dict(kinds)
    unsaid = [
        port
        for port in others
        if kinds[port] is DeviceKind.MOTOR and not means_large(_names(port, mentions))
    ]
    return {**kinds, **dict.fromkeys(unsaid, DeviceKind.MEDIUM)}


def _names(port: str, mentions: Mentions) -> list[str]:
    return [name for one in mentions.devices if one.port == port for name in one.names]
