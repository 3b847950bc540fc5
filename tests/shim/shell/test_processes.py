"""Processes that a program starts on the brick."""

from __future__ import annotations

import pytest

from tests.shim.conftest import RunOn
from tuisim.core.profile import PROFILES

SETUP = """
import asyncio, concurrent.futures, contextlib, io, multiprocessing, os, subprocess, time
from multiprocessing import shared_memory
from subprocess import PIPE, DEVNULL, STDOUT, Popen
def ms(): return round((time.time() - start) * 1000)
"""


@pytest.mark.parametrize("profile", PROFILES)
def test_a_command_that_is_not_there_has_return_code_127(run_on: RunOn, profile: str) -> None:
    done = run_on(
        f"{SETUP}print(os.waitstatus_to_exitcode(os.system('ls')), subprocess.run(['ls']).returncode, "
        "subprocess.run('ls', shell=True).returncode, Popen(['ls']).wait())",
        profile=profile,
    )
    assert done.lines == ["127 127 127 127"]
