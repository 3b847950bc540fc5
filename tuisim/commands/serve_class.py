"""`tuisim serve --students`: a link, folders and an app for each student of a class, and a page for the tutor."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from tuisim.commands.app import Opened
from tuisim.commands.echo import echo, echo_written
from tuisim.commands.isolation import isolates
from tuisim.config.command_line import Arguments
from tuisim.config.mats import background
from tuisim.errors import ConfigError

if TYPE_CHECKING:
    from tuisim.web.visit import VisitLimits

DEFAULT_HOMES = "students"
_ONLY_HERE = ("homes", "links", "isolate", "no_isolate")
"""Options that mean nothing without a class."""


def check_no_class(arguments: Arguments) -> None:
    """Check that no option is given that is for a class only.

    Raises:
        ConfigError: one is.
    """
    for name in _ONLY_HERE:
        if getattr(arguments, name):
            key = f"--{name.replace('_', '-')}"
            raise ConfigError("is for a class", "give --students FILE, too", key=key)


def serve_class(
    arguments: Arguments,
    opened: Opened,
    words: Sequence[str],
    limits: VisitLimits,
    report: Callable[[str], None],
    address_of: Callable[[int, str], str],
) -> int:
    """Serve a class until the user ends it. Return the exit code.

    Args:
        arguments: Those of the command.
        opened: What every app opens, checked.
        words: The same as words.
        limits: How long each app lasts.
        report: Called with what an app that has failed wrote to stderr.
        address_of: Returns an address, by the port and the secret part.

    Raises:
        ConfigError: the list is wrong, the folders cannot be used, or the apps cannot be isolated, and must be.
    """
    from tuisim.web import server
    from tuisim.web.class_links import open_class, write_links
    from tuisim.web.class_list import read_class
    from tuisim.web.classroom import Classroom, limits_of
    from tuisim.web.student_app import app_of, handed_out

    if arguments.run is not None:
        raise ConfigError("a stored run is yours only", "leave it out, or --students", key="--run")
    names = read_class(Path(arguments.students))
    danger = "students' programs can read and change your files and those of others"
    isolated = isolates(arguments, danger, "in-a-browser")
    links = open_class(Path(arguments.homes or DEFAULT_HOMES), names)

    def announce(port: int) -> None:
        rows = [
            ("tutor", links.tutor),
            *((student.name, student.token) for student in links.students),
        ]
        rows = [(name, address_of(port, token)) for name, token in rows]
        _print_links(rows)
        if arguments.links:
            write_links(Path(arguments.links), rows[1:])
            echo_written(arguments.links)
        sys.stdout.flush()

    try:
        handed = handed_out(words, [background(opened.prepared.spec.world.background).image])
        start = partial(app_of, handed=handed, isolated=isolated)
        classroom = Classroom(
            links, arguments.host, start, limits_of(links, arguments.max_visitors, limits), report
        )
        return server.serve(classroom, arguments.host, arguments.port, announce)
    finally:
        os.close(links.lock_fd)


def _print_links(rows: Sequence[tuple[str, str]]) -> None:
    # Not a table that is cut where the terminal is narrow: half of a link is of no use.
    width = max(len(name) for name, _ in rows)
    echo(f"{'name':{width}}  link")
    for name, link in rows:
        echo(f"{name:{width}}  {link}")
    echo(
        "Give each student the link of the name only, and keep the first to yourself; ctrl+c ends the server."
    )
