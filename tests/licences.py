"""Lists the licences of everything that an install of tuisim brings.

In a bare environment with nothing but tuisim: `python -m tests.licences > tuisim/guide/pages/licences.md`.
"""

from __future__ import annotations

import re
from importlib.metadata import Distribution, distributions

HEAD = """\
+++
about = "The licence of each package that an install of tuisim brings."
words = "license dependencies packages third party"
+++

# Licences of the packages

The packages that an install of tuisim brings, without its extras, and what each says about its licence. `python -m
tests.licences` in a fresh environment makes this page.

| package | licence |
| --- | --- |
"""
NOT_BROUGHT = {"tuisim", "pip", "setuptools", "wheel"}


def licence(found: Distribution) -> str:
    """Return what a package says about its licence: an expression, its classifiers, or the first line of a text."""
    said = found.metadata.json
    classifiers = [
        one.rpartition(" :: ")[2]
        for one in said.get("classifier", [])
        if one.startswith("License ::")
    ]
    text = str(said.get("license", "")).strip().split("\n")[0]
    return str(said.get("license_expression") or ", ".join(classifiers) or text)


def packages() -> dict[str, str]:
    """Return the licence of each package by name."""
    found = {re.sub(r"[-_.]+", "-", one.name).lower(): licence(one) for one in distributions()}
    return {name: found[name] for name in sorted(found.keys() - NOT_BROUGHT)}


if __name__ == "__main__":
    print(HEAD + "".join(f"| {name} | {text} |\n" for name, text in packages().items()), end="")
