"""Program text as Python reads it: from bytes, and line by line."""

from __future__ import annotations

from tuisim.errors import ConfigError


def source_lines(text: str) -> list[str]:
    """Return the lines of a program, without their ends, as Python counts them.

    Python knows three line ends. `str.splitlines` knows more, such as form feed and U+2028: with it every line after
    one of them would have another number than in an error or at a breakpoint.
    """
    lines = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    # What ends the last line does not begin another one.
    return lines if lines[-1] else lines[:-1]


def decode_source(data: bytes, shown: str) -> tuple[str, str]:
    """Return the text of a program file, and its encoding as Python names it.

    Args:
        data: The file.
        shown: Its name, for the error.

    Raises:
        ConfigError: it is no text, or in an encoding that is none of text.
    """
    # Imported here: the process that runs a program has no bytes to read.
    import io
    import tokenize

    try:
        encoding, _ = tokenize.detect_encoding(io.BytesIO(data).readline)
        return data.decode(encoding), encoding
    # Such as `rot13`, which is a codec but none for text, and `undefined`, which decodes nothing.
    except (SyntaxError, LookupError, ValueError) as error:
        raise ConfigError(f"is not Python text: {error}", "save it as UTF-8", file=shown) from None
