"""The editor that the user has chosen for all programs of the terminal."""

from __future__ import annotations

import os
import shlex
from collections.abc import Mapping

from tuisim.errors import TuisimError

VARIABLES = ("VISUAL", "EDITOR")
"""What names the editor; the first that is set counts."""


def own_editor(environment: Mapping[str, str] = os.environ) -> list[str]:
    """Return the command of the editor, without the file.

    Raises:
        TuisimError: none is named, or its command cannot be read.
    """
    for variable in VARIABLES:
        named = environment.get(variable, "")
        try:
            if command := shlex.split(named):
                return command
        except ValueError as error:
            raise TuisimError(f"{variable}={named}: {error}") from None
    raise TuisimError("No editor is chosen: VISUAL and EDITOR are not set", "export EDITOR=nano before tuisim starts")
