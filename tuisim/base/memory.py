"""Memory of the process that the C library manages."""

from __future__ import annotations

import ctypes
from contextlib import suppress

LARGE_BLOCK_BYTES = 4 << 20
"""Smaller than the picture of a mat, and larger than what most frames of an app allocate."""
_M_MMAP_THRESHOLD = -3
"""An option of glibc; see mallopt(3)."""


def return_freed_blocks() -> None:
    """Let the C library give blocks of LARGE_BLOCK_BYTES or more back to the system as soon as they are freed.

    By itself glibc keeps freed blocks of up to 32 MB for later: after a few pictures of mats, these take more memory
    than an app uses.
    """
    # Other C libraries have no such function.
    with suppress(AttributeError):
        ctypes.CDLL(None).mallopt(_M_MMAP_THRESHOLD, LARGE_BLOCK_BYTES)
