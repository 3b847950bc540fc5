"""`tuisim serve`: the app in a browser."""

from __future__ import annotations

import socket
import sys
from functools import partial
from typing import TYPE_CHECKING, Any

from tuisim.commands.app import OPENED, read_opened
from tuisim.commands.echo import echo, echo_error_lines
from tuisim.commands.serve_class import DEFAULT_HOMES, check_no_class, serve_class
from tuisim.config.command_line import Arguments, WordType, command, option, words_without
from tuisim.config.options import parse
from tuisim.core.values import Number, Whole
from tuisim.errors import ConfigError

if TYPE_CHECKING:
    from tuisim.web.gate import Gate

DEFAULT_PORT, DEFAULT_VISITORS, DEFAULT_KEEP_MIN = 8000, 8, 60.0
_GROUP, _CLASS = "Server", "Class"
_PORT, _VISITORS, _MINUTES = Whole(0, 65535), Whole(1, 1000), Number(0.001, 100_000)
_SERVER = (
    option(
        "--port",
        default=DEFAULT_PORT,
        metavar="N",
        group=_GROUP,
        type=WordType(lambda text: parse(_PORT, text, "--port")),
        help=f"Port; 0 for any free one ({DEFAULT_PORT}).",
    ),
    option(
        "--max-visitors",
        default=None,
        metavar="N",
        group=_GROUP,
        type=WordType(lambda text: parse(_VISITORS, text, "--max-visitors")),
        help=f"Most apps at the same time ({DEFAULT_VISITORS}, or one a student), with those that no tab shows now.",
    ),
    option(
        "--keep",
        default=DEFAULT_KEEP_MIN,
        metavar="MIN",
        group=_GROUP,
        type=WordType(lambda text: parse(_MINUTES, text, "--keep")),
        help=f"End an app that no tab has shown for so many minutes ({DEFAULT_KEEP_MIN:g}).",
    ),
    option(
        "--idle",
        default=None,
        metavar="MIN",
        group=_GROUP,
        type=WordType(lambda text: parse(_MINUTES, text, "--idle")),
        help="End the app of a visitor after so many minutes without input (never).",
    ),
    option(
        "--host",
        default="127.0.0.1",
        metavar="ADDRESS",
        group=_GROUP,
        help="Listen on another address than 127.0.0.1, which only this machine reaches; nothing is encrypted.",
    ),
    option(
        "--students",
        default=None,
        metavar="FILE",
        type=WordType(),
        group=_CLASS,
        help="Give each student of a list a link of its own: a text or CSV file with a name a line.",
    ),
    option(
        "--homes",
        default=None,
        metavar="FOLDER",
        type=WordType(),
        group=_CLASS,
        help=f"Folder of the students' folders, which stay for the next time ({DEFAULT_HOMES}).",
    ),
    option(
        "--links",
        default=None,
        metavar="FILE",
        type=WordType(),
        group=_CLASS,
        help="Write names and links as CSV, which only you can read.",
    ),
    option(
        "--isolate",
        is_flag=True,
        group=_CLASS,
        help="Refuse to serve where the students' apps cannot be isolated from each other and from your files.",
    ),
    option(
        "--no-isolate",
        "no_isolate",
        is_flag=True,
        group=_CLASS,
        help="Do not isolate them; otherwise each runs through bubblewrap, where that starts.",
    ),
)


@command(
    *_SERVER,
    *OPENED,
    passes_arguments=True,
    help="""Open the app in a browser.

    Prints an address with a secret part. Whoever has this address can run programs as you. ctrl+c ends the server and
    the apps of all visitors.

    With --students, each student of a class has a link, folders and an app with limits, and you have a page of all of
    them: see tuisim guide in-a-browser.

    PROGRAM and options are those of `tuisim open`. This command needs the extra `web`.
    """,
)
def serve(**given: Any) -> int:
    """Serve the app until the user ends it.

    Raises:
        ConfigError: the extra is missing, the address cannot be used, or what to open is wrong.
    """
    arguments = Arguments(**given)
    if arguments.students is None:
        check_no_class(arguments)
    # Checked here, where the user can read what is wrong.
    opened = read_opened(arguments)
    if opened is None:
        return 0
    try:
        from tuisim.web import server
    except ImportError as error:
        hint = "pip install -e '.[web]' in the clone of tuisim"
        raise ConfigError("needs textual-serve", hint, key="serve") from error
    from tuisim.web.app_command import app_command
    from tuisim.web.gate import Gate
    from tuisim.web.visit import VisitLimits

    idle_s = float("inf") if arguments.idle is None else 60 * arguments.idle
    limits, words = VisitLimits(idle_s, 60 * arguments.keep), words_without(_SERVER)
    if arguments.students is not None:
        return serve_class(
            arguments, opened, words, limits, echo_error_lines, partial(_address, arguments.host)
        )
    gate = Gate(arguments.host)
    most = server.ServerLimits(arguments.max_visitors or DEFAULT_VISITORS, limits)
    visitors = server.Server(app_command(words), gate, most, echo_error_lines)
    return server.serve(
        visitors, arguments.host, arguments.port, lambda port: _announce(gate, port)
    )


def _address(listens_on: str, port: int, token: str) -> str:
    """Return the address of a page."""
    from tuisim.web.gate import is_any_address

    host = socket.gethostname() if is_any_address(listens_on) else listens_on
    host = f"[{host}]" if ":" in host else host
    return f"http://{host}:{port}/{token}/"


def _announce(gate: Gate, port: int) -> None:
    echo(
        f"Open {_address(gate.listens_on, port, gate.token)} in a browser. Whoever has this address can run programs "
        "as you; ctrl+c ends the server."
    )
    sys.stdout.flush()
