"""Another program in the terminal of the app."""

from __future__ import annotations

import signal
import sys
from pathlib import Path

import pytest

from tuisim.terminal.driver import run_in_foreground


def test_the_app_waits_for_another_program_and_ignores_its_interrupt(tmp_path: Path) -> None:
    before = signal.getsignal(signal.SIGINT)
    program = "import os, signal, sys; os.kill(os.getppid(), signal.SIGINT); open(sys.argv[1], 'w').close()"
    # Also where it starts so late that this process already ignores the signal.
    run_in_foreground(
        [sys.executable, "-c", f"import time; time.sleep(0.2); {program}", str(tmp_path / "done")]
    )
    assert (tmp_path / "done").exists()
    assert signal.getsignal(signal.SIGINT) is before


def test_lending_the_terminal_to_a_missing_program_raises() -> None:
    with pytest.raises(FileNotFoundError):
        run_in_foreground(["no_such_editor"])
