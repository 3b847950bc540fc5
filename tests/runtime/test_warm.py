"""The process from which runs are forked, as programs see it."""

from __future__ import annotations

import pytest

from tests.runs.child.test_warm import printed
from tuisim.config.build import build_run_spec
from tuisim.config.options import Settings
from tuisim.runs.child import process
from tuisim.runs.run_folder import field_files

SURROUNDINGS = {
    "modules": "print(sorted(sys.modules))",
    "environment": "print(sorted(os.environ.items()))",
    # Another test may replace a file of the cache, which is then "(deleted)".
    "files": "print(sorted(os.path.basename(os.path.realpath(f'/proc/self/fd/{fd}')).partition(':')[0]"
    ".partition(' ')[0] for fd in os.listdir('/proc/self/fd') if os.path.exists(f'/proc/self/fd/{fd}')))",
    "limits": "print([resource.getrlimit(getattr(resource, n)) for n in dir(resource) if n.startswith('RLIMIT')])",
    "random": "print(random.random(), os.urandom(4), hash('a'), uuid.uuid4())",
    "interpreter": "print(sys.flags, sys.path, list(map(type, sys.meta_path)), gc.get_threshold(), gc.isenabled())",
    "signals": "print([(n, type(signal.getsignal(n))) for n in range(1, 32)], signal.pthread_sigmask(0, []))",
    "session": "print(os.getcwd(), os.getsid(0) == os.getpid(), os.getpgrp() == os.getpid(), os.umask(0o77))",
    "threads": "print(threading.active_count(), _thread._count(), os.listdir('/proc/self/task') == [str(os.getpid())])",
    "times": "print(time.time(), time.process_time(), datetime.datetime.now())",
}


IMPORTS = "import datetime, gc, os, random, resource, signal, sys, threading, time, uuid, _thread\n"


@pytest.mark.quick_cases("modules-preloaded", "environment-preloaded", "random-preloaded")
@pytest.mark.parametrize("prelude", ["none", "preloaded"])
@pytest.mark.parametrize("name", SURROUNDINGS)
def test_a_program_cannot_tell_how_it_was_started(name: str, prelude: str, monkeypatch: pytest.MonkeyPatch) -> None:
    # The kept one may be older than a limit of this process.
    process.cool_down()
    text = (IMPORTS if name != "modules" else "import os, sys\n") + SURROUNDINGS[name]
    printed("print('prepares the template')", True, prelude)
    forked = printed(text, False, prelude), printed(text, True, prelude)
    monkeypatch.setattr(process, "_fork", lambda *_: None)
    alone = printed(text, False, prelude)
    assert forked == (alone, alone)


@pytest.mark.usefixtures("real_mats", "home")
def test_a_template_does_not_keep_a_damaged_mat() -> None:
    text = "print(colorLeft.reflected_light_intensity_pc)"
    (seen,) = printed(text, True, "preloaded")
    files = field_files(build_run_spec(Settings({"seed": 3, "noise.light": 10})))
    for path in (files.pixels, *(path for _, path in files.sums)):
        # In place: the template has mapped it.
        with path.open("r+b") as stream:
            stream.write(bytes(path.stat().st_size))
    assert printed(text, True, "preloaded") == [seen]
    assert float(seen) > 0
