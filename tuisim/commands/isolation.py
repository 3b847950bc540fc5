"""The options `--isolate` and `--no-isolate` of commands that run the programs of others."""

from __future__ import annotations

from tuisim.commands.echo import echo_error
from tuisim.config.command_line import Arguments
from tuisim.errors import ConfigError, see_page
from tuisim.runs.child.isolation import check_isolation


def isolates(arguments: Arguments, danger: str, page: str) -> bool:
    """Return whether programs are isolated; say so if they are not, and nobody has asked for that.

    Args:
        arguments: Those of the command, with `isolate` and `no_isolate`.
        danger: What programs can do that are not isolated.
        page: The page of the guide that tells more.

    Raises:
        ConfigError: they cannot be isolated, and must be; or the options contradict each other.
    """
    if arguments.isolate and arguments.no_isolate:
        raise ConfigError(
            "is given together with --no-isolate", "give only one of them", key="--isolate"
        )
    if arguments.no_isolate:
        return False
    try:
        check_isolation()
    except ConfigError as error:
        if arguments.isolate:
            raise
        reason = error.message.removeprefix(f"{error.key}: ")
        echo_error(f"note: {reason}: {danger} ({see_page(page)})")
        return False
    return True
