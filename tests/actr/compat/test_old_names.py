"""The old names: importable while a model is being loaded, all of them, and only then."""

import importlib
import sys
from types import ModuleType

import pytest

import actr3d.actr
from actr3d.actr.compat.old_names import PACKAGES, ROOTS, aliases, text_of

PARTS = (
    "",
    "actr",
    "lib",
    "lib.actr",
    "lib.grid",
    "lib.cellular",
    "lib.actr.dm",
    "lib.actr.pm",
    "model",
    "scheduler",
    "logger",
    "pattern",
    "production",
    "runner",
    "display",
    "actr.buffer",
    "actr.dm",
    "actr.pm",
    "actr.core",
    "actr.compile",
    "actr.imaginal",
    "actr.motor",
    "actr.sosvision",
    "actr.text",
    "actr.timer",
    "actr.vision",
)

TABLE = (
    "Model",
    "ProductionSystem",
    "ACTR",
    "Buffer",
    "Chunk",
    "Memory",
    "BlendingMemory",
    "MemorySubModule",
    "DMNoise",
    "DMBaseLevel",
    "DMSalience",
    "DMSpreading",
    "DMFixed",
    "DMAssociate",
    "DMInhibition",
    "Partial",
    "ProceduralSubModule",
    "PMNoise",
    "PMPGC",
    "PMPGCSuccessWeighted",
    "PMPGCMixedWeighted",
    "PMTD",
    "PMNew",
    "PMCompile",
    "SOSVision",
    "Vision",
    "Motor",
    "Timer",
    "TextOutput",
    "ImaginalModule",
    "log",
    "log_everything",
    "finished",
    "run",
    "display",
)


@pytest.mark.parametrize("root", ROOTS)
def test_every_part_can_be_imported(root: str) -> None:
    for part in PARTS:
        name = f"{root}.{part}" if part else root
        before = sys.modules.get(name)  # the real library, which other tests compare with, may be there
        with aliases():
            module = importlib.import_module(name)
            assert module.__name__ == name
            assert hasattr(module, "__path__") == (part in PACKAGES), name
            assert part == "lib" or module.__all__, name
            assert module is not before, name
        assert sys.modules.get(name) is before, name


@pytest.mark.parametrize("root", ROOTS)
def test_import_star_imports_every_name_of_the_table(root: str) -> None:
    space: dict[str, object] = {}
    with aliases():
        exec(f"from {root} import *", space)
    assert set(TABLE) <= space.keys()
    wrong = [name for name in TABLE if name not in ("run", "display") and space[name] is not getattr(actr3d.actr, name)]
    assert wrong == []


@pytest.mark.parametrize(
    "statement",
    ["import ccm", "import ccm.lib.grid", "from ccm.lib import grid", "import python_actr", "from python_actr.lib.grid import World"],
)
def test_ways_to_import(statement: str) -> None:
    space: dict[str, object] = {}
    with aliases():
        exec(statement, space)
        exec("import ccm; ccm.lib.grid.World, ccm.lib.actr.ACTR, ccm.actr.Buffer", space)


def test_the_names_are_gone_afterwards() -> None:
    with aliases():
        importlib.import_module("ccm.lib.grid")
    with pytest.raises(ModuleNotFoundError, match="No module named 'ccm'"):
        importlib.import_module("ccm")


def test_an_unknown_part_is_not_found() -> None:
    with aliases(), pytest.raises(ModuleNotFoundError, match=r"No module named 'ccm.lib.nothing'"):
        importlib.import_module("ccm.lib.nothing")


def test_a_real_library_that_was_imported_before_stays_intact() -> None:
    real = ModuleType("ccm")
    sys.modules["ccm"] = real
    try:
        with aliases():
            assert importlib.import_module("ccm") is not real
        assert sys.modules["ccm"] is real
    finally:
        del sys.modules["ccm"]


def test_blocks_may_be_nested() -> None:
    with aliases():
        outer = importlib.import_module("ccm")
        with aliases():
            assert importlib.import_module("ccm") is not outer
        assert importlib.import_module("ccm") is outer


def test_blocks_may_end_in_any_order() -> None:
    real = ModuleType("ccm")
    sys.modules["ccm"] = real
    try:
        first, second = aliases(), aliases()
        first.__enter__()
        second.__enter__()
        first.__exit__(None, None, None)
        assert importlib.import_module("ccm.lib.grid") is not real
        second.__exit__(None, None, None)
        assert sys.modules["ccm"] is real
        assert "ccm.lib.grid" not in sys.modules
    finally:
        del sys.modules["ccm"]


@pytest.mark.parametrize("root", ROOTS)
@pytest.mark.parametrize("part", PARTS)
def test_the_text_of_an_old_module_gives_the_names_that_the_module_has(root: str, part: str) -> None:
    name = f"{root}.{part}".rstrip(".")
    text, read = text_of(name), dict[str, object]()
    assert text is not None
    with aliases():
        module = vars(importlib.import_module(name))
        exec(text, read)
    own, given = ({key: value for key, value in names.items() if key[:2] != "__"} for names in (module, read))
    assert own == given
    assert module.get("__all__", []) == read["__all__"]


def test_a_module_that_the_old_library_does_not_have_has_no_text() -> None:
    assert [text_of(name) for name in ("ccm.nothing", "python_actr.lib.nothing", "random")] == [None] * 3
