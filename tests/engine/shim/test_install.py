"""Modules are finished once, whenever they were imported."""

from __future__ import annotations

import sys
import types
from pathlib import Path

import pytest

from tuisim.engine.shim.install import finish_imports


@pytest.mark.parametrize("early", [True, False], ids=["imported before", "imported later"])
def test_a_patched_module_is_finished_once_whenever_it_is_imported(
    early: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "something_new.py").write_text("value = 1\n")
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr(sys, "meta_path", list(sys.meta_path))
    monkeypatch.setattr(sys, "modules", dict(sys.modules))

    def finish(module: types.ModuleType) -> None:
        vars(module)["value"] += 1

    if early:
        __import__("something_new")
    finish_imports({"something_new": finish}, lambda _file: False)
    assert __import__("something_new").value == 2
    assert __import__("something_new").value == 2
