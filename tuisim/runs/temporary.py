"""Runs that are not listed: their recordings lie in temporary files until they have been evaluated."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Mapping
from dataclasses import asdict
from datetime import UTC, datetime
from pathlib import Path
from types import TracebackType
from typing import Any

from tuisim.core.spec import RunSpec
from tuisim.protocol import Ended
from tuisim.runs.run_folder import StoredRun, new_run_data, read_run, read_run_file, run_document, write_run_file
from tuisim.runs.store import NewRun
from tuisim.source import Program


class TemporaryRun:
    """Folder of one run that is deleted at the end of a `with` block. It stands in for the store of a `RunHandle`."""

    def __init__(self) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="tuisim-"))

    def __enter__(self) -> TemporaryRun:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        shutil.rmtree(self.folder, ignore_errors=True)

    def new_run(
        self,
        program: Program,
        spec: RunSpec,
        field: Mapping[str, Any] | None = None,
        options: Mapping[str, Any] | None = None,
        live: bool = False,
    ) -> NewRun:
        """Write the `run.json` of a run that is about to start; arguments as in `RunStore.new_run`."""
        created = datetime.now(UTC).isoformat(timespec="milliseconds")
        run_id = self.folder.name
        data = new_run_data(run_id, 0, created, program, spec, field, options, live)
        (self.folder / "run.json").write_bytes(run_document(data))
        return NewRun(run_id, 0, self.folder)

    def finish(self, _run_id: str, _end: Ended) -> None:
        """Do nothing: the handle of the run keeps its end."""

    def forget(self, _run_id: str) -> None:
        """Do nothing: the end of the `with` block deletes the folder."""

    def load_run(self, folder: Path) -> StoredRun:
        """Return the run, without its end; see `RunStore.load_run`."""
        return read_run(folder)

    def write_end(self, end: Ended) -> None:
        """Write the end of the run to its folder, which then is as that of a stored run.

        Raises:
            LogError: it cannot be written.
        """
        write_run_file(self.folder, {**read_run_file(self.folder), "end": asdict(end)})
