"""Restrictions on programs: no processes, limited memory. Not a sandbox."""

from __future__ import annotations

import os
import resource
from typing import Any, NoReturn

from tuisim.engine.runtime import wallclock
from tuisim.engine.runtime.patches.replacement import replace

MEMORY_LIMIT_BYTES = 1 << 30
"""Address space of the child; beyond it the program gets a MemoryError."""

STACK_BYTES = 8 << 20
"""Stack of a thread. It uses memory only as needed."""
STACKS_KEPT = 8
"""Number of stacks of finished threads that may still be allocated."""

_PROCESS_CALLS = (
    "fork",
    "forkpty",
    "posix_spawn",
    "posix_spawnp",
    "execv",
    "execve",
    "execvp",
    "execvpe",
    "execl",
    "execle",
    "execlp",
    "execlpe",
    "spawnv",
    "spawnve",
    "spawnvp",
    "spawnvpe",
    "spawnl",
    "spawnle",
    "spawnlp",
    "spawnlpe",
)


def limit_memory(threads: int = 0) -> None:
    """Limit the process's address space, with additional room for the stacks of `threads` threads."""
    _, hard = resource.getrlimit(resource.RLIMIT_AS)
    stack = wallclock.stack_size() or STACK_BYTES
    limit = MEMORY_LIMIT_BYTES + (threads and threads + STACKS_KEPT) * stack
    limit = limit if hard == resource.RLIM_INFINITY else min(hard, limit)
    try:
        resource.setrlimit(resource.RLIMIT_AS, (limit, hard))
    except (OSError, ValueError):
        # macOS accepts the limit without enforcing it; the run is merely less protected there.
        return


def _build_refusal(name: str) -> Any:
    def refuse(*_args: object, **_kwargs: object) -> NoReturn:
        raise PermissionError(
            f"a program on the simulated brick cannot start other processes: {name}"
        )

    return refuse


def refuse_processes() -> None:
    """Make the functions of `os` that start processes raise PermissionError."""
    for name in _PROCESS_CALLS:
        if hasattr(os, name):
            replace(os, name, _build_refusal(f"os.{name}"))
    # No code of the program may run when the debugger forks to inspect values.
    replace(os, "register_at_fork", lambda **_functions: None)
