"""The names of each module: those that a program imports are those that an editor sees."""

from __future__ import annotations

import ast

import pytest

from tests.conftest import ROOT
from tuisim.engine.core.hub_spec import HUBS
from tuisim.engine.shim.pybricks.modules import MODULES
from tuisim.engine.shim.pybricks.unsimulated import IO_DEVICES, NXT_DEVICES

SEEN = ROOT / "tuisim/engine/shim/names"
REFUSED = {"pybricks.iodevices": set(IO_DEVICES), "pybricks.nxtdevices": set(NXT_DEVICES)}
BUILTINS = {"pybricks.tools": {"print"}}
VERSION_4 = {
    "pybricks.hubs": set(HUBS) - {"InventorHub"},
    "pybricks.parameters": {"Axis", "Font", "Image", "Side"},
    "pybricks.tools": {
        *("Axis", "Matrix", "cross", "multitask", "read_input_byte", "run_task", "vector")
    },
}


@pytest.mark.parametrize("module", MODULES)
def test_an_editor_sees_what_a_program_can_use(module: str) -> None:
    path = SEEN / module.replace(".", "/")
    file = path / "__init__.py" if path.is_dir() else path.with_suffix(".py")
    nodes = ast.parse(file.read_text()).body
    seen = {
        name.asname for node in nodes if isinstance(node, ast.ImportFrom) for name in node.names
    }
    usable = MODULES[module].keys() - REFUSED.get(module, set()) - BUILTINS.get(module, set())
    assert seen == usable | VERSION_4.get(module, set())
