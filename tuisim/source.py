"""A program to run, and its text as Python reads it: from bytes, and line by line."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from tuisim.errors import ConfigError


@dataclass(frozen=True, slots=True)
class Program:
    """A program to run, or that of a stored run."""

    name: str
    """File name as displayed to the user."""
    text: str
    """The source; a magic line is commented out, which keeps the file's line numbers."""
    prelude: str = "none"
    """none, imports or preloaded."""
    path: str = ""
    """Path of its file; empty if it is in no file."""
    arguments: tuple[str, ...] = ()
    """Contents of `sys.argv` after the path."""
    python_path: tuple[str, ...] = ()
    """Folders besides its own in which it searches modules: the user's PYTHONPATH."""
    working_directory: str = ""
    """Initial working directory; empty means the current one, with the PYTHONPATH of this process."""
    module_folder: str = ""
    """Module folder of a program without a file, such as the folder of the notebook whose cell it is."""
    modules_from: Path | None = None
    """Folder of an earlier run: modules are read as that one recorded them; None reads them from their files."""

    @property
    def sha256(self) -> str:
        """Hash of the text in UTF-8, hexadecimal."""
        # Imported here: the child process that runs a program does not need it.
        import hashlib

        return hashlib.sha256(self.text.encode("utf-8", "surrogatepass")).hexdigest()


def source_lines(text: str) -> list[str]:
    """Return the lines of a program, without line endings, numbered as Python numbers them.

    `str.splitlines` also splits at form feed, U+2028 and others; line numbers would then differ from those in
    tracebacks and breakpoints.
    """
    lines = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    # A final line ending does not start another line.
    return lines if lines[-1] else lines[:-1]


def decode_source(data: bytes, shown: str) -> tuple[str, str]:
    """Decode a program file; return its text and its encoding as Python names it.

    Args:
        data: The bytes of the file.
        shown: The file's name, for the error.

    Raises:
        ConfigError: it is not text, or its encoding is not a text encoding.
    """
    # Imported here: the child process that runs a program does not need them.
    import io
    import tokenize

    try:
        encoding, _ = tokenize.detect_encoding(io.BytesIO(data).readline)
        return data.decode(encoding), encoding
    # For example `rot13`, which is not a text encoding, and `undefined`, which always raises.
    except (SyntaxError, LookupError, ValueError) as error:
        raise ConfigError(f"is not Python text: {error}", "save it as UTF-8", file=shown) from None
