"""Program text as Python reads it: from bytes, and line by line."""

from __future__ import annotations

from tuisim.errors import ConfigError


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
