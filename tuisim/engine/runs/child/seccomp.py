"""A filter of system calls for Linux: a process may start threads, but no further process.

Nor may it do what would lead around the other limits: have a namespace of its own, where it could mount memory; memory
that belongs to no address space and no open file, also that which a socket or a pipe holds; calls that a ring makes for
it; and keys of the user.
"""

from __future__ import annotations

import errno
import os
import platform
import socket
import struct

from tuisim.base.data_class import dataclass

_LOAD = 0x20
_EQUAL = 0x15
_AT_LEAST = 0x35
_BITS = 0x45
_RETURN = 0x06
"""Instructions of a classic BPF program: load a word; jump if equal, at least, or if bits are set; return."""
_ALLOW = 0x7FFF0000
_FAIL = 0x00050000
_NUMBER_AT, _ARCHITECTURE_AT, _FIRST_AT, _SECOND_AT, _THIRD_AT = 0, 4, 16, 24, 32
"""Offsets in `struct seccomp_data`; of each argument the lower half, little-endian."""
_CLONE_THREAD = 0x00010000
_X32 = 0x40000000
"""Numbers from here on belong to another calling convention of the same processor."""


@dataclass(frozen=True, slots=True)
class _Machine:
    """The numbers of system calls on one kind of processor, from its tables in Linux."""

    architecture: int
    """`AUDIT_ARCH_…`"""
    clone: int
    setsockopt: int
    refused: tuple[int, ...]
    """fork, vfork; unshare, setns; shmget, msgget, semget; add_key, request_key, keyctl; sendmsg, sendmmsg, which send
    descriptors, too; memfd_create; vmsplice."""
    clone3: int = 435
    refused_everywhere: tuple[int, ...] = (425, 447)
    """io_uring_setup, memfd_secret."""


_MACHINES = {
    "x86_64": _Machine(
        0xC000003E, 56, 54, (57, 58, 272, 308, 29, 68, 64, 248, 249, 250, 46, 307, 319, 278)
    ),
    "aarch64": _Machine(
        0xC00000B7, 220, 208, (97, 268, 194, 186, 190, 217, 218, 219, 211, 269, 279, 75)
    ),
}


def build_filter() -> bytes | None:
    """Return the filter in the form that bubblewrap takes; None for a processor whose calls are not known here."""
    machine = _MACHINES.get(platform.machine())
    if machine is None:
        return None
    fails = _FAIL | errno.EPERM
    unknown = _FAIL | errno.ENOSYS
    nothing = _FAIL
    program = [
        _pack_instruction(_LOAD, _ARCHITECTURE_AT),
        # Calls of another architecture have other numbers.
        _pack_instruction(_EQUAL, machine.architecture, 1, 0),
        _pack_instruction(_RETURN, fails),
        _pack_instruction(_LOAD, _NUMBER_AT),
        _pack_instruction(_AT_LEAST, _X32, 0, 1),
        _pack_instruction(_RETURN, unknown),
        # clone3 has its flags in memory, which a filter cannot read. Without it the C library uses clone.
        _pack_instruction(_EQUAL, machine.clone3, 0, 1),
        _pack_instruction(_RETURN, unknown),
    ]
    for number in (*machine.refused, *machine.refused_everywhere):
        program += [_pack_instruction(_EQUAL, number, 0, 1), _pack_instruction(_RETURN, fails)]
    program += [
        # A socket's buffers are memory, too: they keep their size, but setsockopt reports success.
        _pack_instruction(_EQUAL, machine.setsockopt, 0, 7),
        _pack_instruction(_LOAD, _SECOND_AT),
        _pack_instruction(_EQUAL, socket.SOL_SOCKET, 0, 4),
        _pack_instruction(_LOAD, _THIRD_AT),
        _pack_instruction(_EQUAL, socket.SO_SNDBUF, 1, 0),
        _pack_instruction(_EQUAL, socket.SO_RCVBUF, 0, 1),
        _pack_instruction(_RETURN, nothing),
        _pack_instruction(_RETURN, _ALLOW),
        _pack_instruction(_EQUAL, machine.clone, 1, 0),
        _pack_instruction(_RETURN, _ALLOW),
        _pack_instruction(_LOAD, _FIRST_AT),
        _pack_instruction(_BITS, _CLONE_THREAD, 0, 1),
        _pack_instruction(_RETURN, _ALLOW),
        _pack_instruction(_RETURN, fails),
    ]
    return b"".join(program)


def _pack_instruction(code: int, operand: int, if_true: int = 0, if_false: int = 0) -> bytes:
    return struct.pack("=HBBI", code, if_true, if_false, operand)


def filter_descriptor() -> int | None:
    """Return a descriptor from which the filter can be read once; None if `build_filter` has none.

    Raises:
        OSError: this process can open no more files.
    """
    content = build_filter()
    if content is None:
        return None
    read_fd, write_fd = os.pipe()
    os.write(write_fd, content)
    os.close(write_fd)
    return read_fd
