"""`tuisim config`: the user's settings, and where each comes from."""

from __future__ import annotations

from tuisim.base.errors import ConfigError
from tuisim.commands.echo import AS_JSON, draw_table, echo, echo_json, echo_lines
from tuisim.programs.program_settings import PROGRAM_PATHS
from tuisim.settings.command_line import argument, command, option
from tuisim.settings.user_config import FILE, SETTINGS, UserConfig, write_template


@command(
    argument("words", "", nargs=-1),
    AS_JSON,
    option(
        "--init",
        is_flag=True,
        help=f"Write a {FILE} with every setting as a comment, unless the file exists.",
    ),
    name="config",
    help=f"""Show your settings and keys, and where each comes from; check {FILE}.

    The first line is the path of the file. Empty values depend on the mat or the robot; `tuisim guide settings`
    explains the settings.
    """,
)
def config(words: tuple[str, ...], as_json: bool, init: bool) -> int:
    """Print the user's settings, or write `config.toml`.

    Raises:
        ConfigError: something in the file is wrong, or it exists already; or there are further words.
    """
    if words:
        raise ConfigError(
            "this command changes no setting",
            f"`tuisim config --init` writes {FILE}: change the setting there with an editor",
            key=f"config {' '.join(words)}",
        )
    if init:
        if as_json:
            raise ConfigError(
                "--init and --json cannot be combined", "give --init or --json", key="config"
            )
        echo(f"written: {write_template()}")
        return 0
    settings = UserConfig.load().checked()
    from tuisim.app.actions.keys import check_config

    check_config(settings)
    rows = [
        (path, settings.value(path), FILE if path in settings.written else _describe_default(path))
        for path in SETTINGS
    ]
    rows += [(f"keys.{name}", ", ".join(keys), FILE) for name, keys in settings.keys.items()]
    exists = settings.path.exists()
    if as_json:
        listed = [{"setting": path, "value": value, "from": source} for path, value, source in rows]
        echo_json({"file": str(settings.path), "exists": exists, "settings": listed})
        return 0
    echo(
        str(settings.path)
        if exists
        else f"{settings.path} does not exist: `tuisim config --init` writes it"
    )
    echo()
    cells = [(path, _format_value(value), source) for path, value, source in rows]
    echo_lines(draw_table(("setting", "value", "from"), cells))
    return 0


def _describe_default(path: str) -> str:
    return "default, or from the program" if SETTINGS[path].sets in PROGRAM_PATHS else "default"


def _format_value(value: object) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)
