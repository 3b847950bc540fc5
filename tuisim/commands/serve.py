"""`tuisim serve`: the app in a browser."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

from tuisim.base.errors import ConfigError
from tuisim.commands.app import OPENED, read_opened
from tuisim.commands.echo import echo, echo_error_lines
from tuisim.engine.core.values import Number, Whole
from tuisim.settings.command_line import Arguments, command, drop_options, option
from tuisim.settings.shared_options import build_type

if TYPE_CHECKING:
    from tuisim.web.gate import Gate

DEFAULT_PORT = 8000
DEFAULT_VISITORS = 8
DEFAULT_KEEP_MIN = 60.0
_GROUP = "Server"
_INSTEAD = (
    "for a class use accounts over SSH, or JupyterHub with %sim_app: tuisim guide in-a-browser"
)
"""The hint for options that only a server for a class has."""
_PORT, _VISITORS, _MINUTES = Whole(0, 65535), Whole(1, 1000), Number(0.001, 100_000)
_SERVER = (
    option(
        "--port",
        default=DEFAULT_PORT,
        metavar="N",
        group=_GROUP,
        type=build_type(_PORT, "--port"),
        help=f"Port; 0 for any free one ({DEFAULT_PORT}).",
    ),
    option(
        "--max-visitors",
        default=DEFAULT_VISITORS,
        metavar="N",
        group=_GROUP,
        type=build_type(_VISITORS, "--max-visitors"),
        help=f"Maximum number of apps at the same time ({DEFAULT_VISITORS}), including those that no tab shows.",
    ),
    option(
        "--keep",
        default=DEFAULT_KEEP_MIN,
        metavar="MIN",
        group=_GROUP,
        type=build_type(_MINUTES, "--keep"),
        help=f"End an app that no tab has shown for this many minutes ({DEFAULT_KEEP_MIN:g}); an unused one, after 1.",
    ),
    option(
        "--idle",
        default=None,
        metavar="MIN",
        group=_GROUP,
        type=build_type(_MINUTES, "--idle"),
        help="End the app of a visitor after this many minutes without input (never).",
    ),
    option(
        "--host",
        default="127.0.0.1",
        metavar="ADDRESS",
        group=_GROUP,
        help="Listen on this address; only this machine can reach the default, 127.0.0.1. Nothing is encrypted.",
    ),
)


@command(
    *_SERVER,
    *OPENED,
    passes_arguments=True,
    instead=dict.fromkeys(
        ("--students", "--homes", "--links", "--isolate", "--no-isolate"), _INSTEAD
    ),
    help="""Open the app in a browser.

    The command prints an address with a secret part. Whoever has this address can run programs as you. ctrl+c ends
    the server and the apps of all visitors.

    PROGRAM and options are those of `tuisim open`. This command needs the extra `web`.
    """,
)
def serve(**given: Any) -> int:
    """Serve the app to browsers until the user ends it, and return the exit code.

    Raises:
        ConfigError: the extra is missing, the address cannot be used, or what to open is wrong.
    """
    arguments = Arguments(**given)
    # The arguments are checked here, so that errors appear in the user's terminal.
    opened = read_opened(arguments)
    if opened is None:
        return 0
    try:
        from tuisim.web import server
    except ImportError as error:
        hint = "pip install -e '.[web]' in the clone of tuisim"
        raise ConfigError("needs textual-serve", hint, key="serve") from error
    from tuisim.web.gate import Gate
    from tuisim.web.session import build_app_command
    from tuisim.web.visit import VisitLimits

    idle_s = float("inf") if arguments.idle is None else 60 * arguments.idle
    limits = server.ServerLimits(arguments.max_visitors, VisitLimits(idle_s, 60 * arguments.keep))
    gate = Gate(arguments.host)
    visitors = server.Server(
        build_app_command(drop_options(_SERVER)), gate, limits, echo_error_lines
    )
    return visitors.serve(arguments.host, arguments.port, lambda port: _announce(gate, port))


def _announce(gate: Gate, port: int) -> None:
    echo(
        f"Open {gate.format_address(port)} in a browser. Whoever has this address can run programs as you; "
        "ctrl+c ends the server."
    )
    sys.stdout.flush()
