"""Every device of the table is a folder of files that exist, open and read, and nothing else is in the tree."""

from __future__ import annotations

from tests.engine.shim.conftest import RunOn

WALK = """
import errno, os
count = 0
for folder, names, files in os.walk('/sys/class'):
    for name in files:
        path = os.path.join(folder, name)
        count += 1
        assert os.path.isfile(path) and os.path.exists(path), path
        try:
            text = open(path).read() if os.access(path, os.R_OK) else 'write-only\\n'
        except OSError as error:
            print(path, errno.errorcode[error.errno])
        else:
            assert text.endswith('\\n') or name == 'bin_data', (path, text)
print(count > 200)
"""


def test_every_device_file_that_is_listed_can_be_read(run_on: RunOn) -> None:
    lines = run_on(WALK, "eyes", "furnished").lines
    assert lines[-1] == "True"
    # As from the drivers: LEGO's sensors take no commands, and have values only as far as the mode has them.
    told = {f"value{n} EINVAL" for n in range(1, 8)} | {"commands ENOTSUP"}
    assert {line.rpartition("/")[2] for line in lines[:-1]} == told
