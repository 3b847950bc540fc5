"""`python -m tests.proof --help`: try to break tuisim, and print one table."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence
from itertools import islice
from math import inf
from random import Random

from tests.proof.attempts import Result, attempts
from tests.proof.kind import fault_of
from tests.proof.kinds import KINDS
from tests.proof.mutants import main as try_mutants


def row(kind: str, cases: object, elapsed: str, faults: object) -> str:
    """Return a row of the table."""
    return f"{kind:<12} {cases:>8} {elapsed:>10} {faults:>8}"


def describe_kinds() -> str:
    """Return what the help says about the kinds."""
    about = "\n".join(f"  {name:<12}{kind.about}" for name, kind in KINDS.items())
    return f"Try to break tuisim in these ways:\n\n{about}\n\n`mutants --help`: try its tests"


def print_results(results: Sequence[Result], of_what: str) -> int:
    """Print a table and a verdict; return 1 if there was a fault."""
    print(row("kind", "cases", "wall s", "faults"))
    for found in results:
        print(row(found.kind, found.cases, f"{found.elapsed_s:.1f}", len(found.faults)))
    cases = sum(found.cases for found in results)
    faults = sum(len(found.faults) for found in results)
    print(f"{faults or 'no'} fault{'s' * (faults > 1)} in {cases} cases ({of_what})")
    return int(bool(faults))


def main(words: Sequence[str]) -> int:
    """Try what was asked for; return 1 if there was a fault."""
    if words[:1] == ["mutants"]:
        return try_mutants(words[1:])
    parser = argparse.ArgumentParser(
        prog="python -m tests.proof",
        description=describe_kinds(),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("kinds", nargs="*", metavar="KIND", help="some of them; otherwise all")
    parser.add_argument(
        "--minutes", type=float, default=3.0, metavar="N", help="in total (default: 3)"
    )
    parser.add_argument(
        "--seed", type=int, metavar="N", help="of the cases that are drawn (default: a fresh one)"
    )
    parser.add_argument(
        "--fixed", action="store_true", help="only the same cases each time, however long it takes"
    )
    parser.add_argument(
        "--jobs", type=int, default=min(os.cpu_count() or 1, 4), metavar="N", help="kinds at a time"
    )
    parser.add_argument(
        "--case", metavar="NAME", help="only this case of one KIND, as printed with a fault"
    )
    parser.add_argument(
        "--list", type=int, metavar="N", help="print the first N names of cases of each kind"
    )
    arguments = parser.parse_args(words)
    if unknown := [name for name in arguments.kinds if name not in KINDS]:
        parser.error(f"no such kind: {', '.join(unknown)}; one of {', '.join(KINDS)}")
    kinds = arguments.kinds or list(KINDS)
    seed = arguments.seed if arguments.seed is not None else int.from_bytes(os.urandom(4))
    if arguments.case is not None:
        if len(kinds) != 1:
            parser.error("--case needs one KIND")
        text = fault_of(KINDS[kinds[0]], arguments.case)
        print(text or "no fault")
        return int(bool(text))
    if arguments.list is not None:
        for kind in kinds:
            print(kind, *islice(KINDS[kind].names(Random(f"{seed} {kind}")), arguments.list))
        return 0
    if arguments.fixed:
        return print_results(list(attempts(kinds, None, inf, arguments.jobs)), "fixed seeds")
    print(f"seed {seed}", flush=True)
    results = list(attempts(kinds, seed, arguments.minutes, arguments.jobs))
    return print_results(results, f"seed {seed}")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
