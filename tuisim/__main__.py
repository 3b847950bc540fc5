"""`python -m tuisim` and the `tuisim` command."""

from __future__ import annotations

import sys


def main() -> int:
    """Run the command line and return its exit code."""
    from tuisim.cli import run_command

    return run_command(sys.argv[1:])


if __name__ == "__main__":
    # With `-m`, Python looks in the current folder first: a file there may be called as one of Python's own.
    if not sys.flags.safe_path:
        sys.path.append(sys.path.pop(0))
    sys.exit(main())
