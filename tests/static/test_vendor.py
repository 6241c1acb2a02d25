"""What the page uses of other people's work is what its manifest says, and the page loads nothing from anywhere else."""

from __future__ import annotations

import hashlib
import json
import re
from pathlib import Path

import pytest

from workbench import page_files
from workbench.shipped import static

VENDOR = static() / "vendor"
MANIFEST = json.loads((VENDOR / "manifest.json").read_text(encoding="utf-8"))
OWN = sorted(path for path in static().rglob("*") if path.suffix in (".html", ".css", ".js", ".svg") and VENDOR not in path.parents)
MODULES = [path for path in OWN if path.suffix == ".js"]
MADE = {(static() / name).resolve(): set[Path]() for name in page_files.GENERATED if name.endswith(".js")}
MADE[(static() / "panels.js").resolve()] |= set((static() / "panels").resolve().glob("*.js"))
"""The modules that the server makes, and what they import."""
ELSEWHERE = re.compile(r"""(?:https?:|wss?:)?//(?!www\.w3\.org/)[\w-]+(?:\.[\w-]+)+""")


def test_a_bundle_is_the_one_in_the_manifest() -> None:
    found = {file["name"]: hashlib.sha256((VENDOR / file["name"]).read_bytes()).hexdigest() for file in MANIFEST["files"]}
    assert found == {file["name"]: file["sha256"] for file in MANIFEST["files"]}
    assert found


def test_the_manifest_names_every_bundle_and_every_package_has_its_licence() -> None:
    there = {path.name for path in VENDOR.iterdir() if path.is_file()} - {"manifest.json", "README.md"}
    assert there == {file["name"] for file in MANIFEST["files"]}
    licences = (VENDOR / "LICENSES.txt").read_text(encoding="utf-8")
    for package in MANIFEST["packages"]:
        assert f"{package['name']} {package['version']}\n" in licences
        assert package["license"] in ("MIT", "Apache-2.0", "MPL-2.0")
        if package["license"] == "MPL-2.0":  # it demands a note on where to get the source code
            assert f"{package['name']} {package['version']}\n\nSource code: https://" in licences


def test_a_file_of_the_page_loads_nothing_from_elsewhere() -> None:
    assert len(OWN) > 100
    found = {str(path): ELSEWHERE.findall(path.read_text(encoding="utf-8")) for path in OWN}
    assert {path: addresses for path, addresses in found.items() if addresses} == {}


def test_what_a_module_imports_is_there() -> None:
    missing: list[str] = []
    for path in MODULES:
        for name in re.findall(r"""(?:import|from)\s*\(?\s*["']([^"']+)["']""", path.read_text(encoding="utf-8")):
            there = (path.parent / name).is_file() or (path.parent / name).resolve() in MADE
            if not (name.startswith(".") and there):
                missing.append(f"{path}: {name}")
    assert missing == []


def test_a_module_uses_what_it_imports() -> None:
    unused: list[str] = []
    for path in MODULES:
        text = path.read_text(encoding="utf-8")
        for names in re.findall(r"^import \{([^}]*)\} from", text, re.MULTILINE):
            own = [each.split(" as ")[-1].strip() for each in names.split(",")]
            unused += [f"{path}: {name}" for name in own if len(re.findall(rf"(?<![\w$]){re.escape(name)}(?![\w$])", text)) < 2]
    assert unused == []


def imports(path: Path) -> set[Path]:
    """Returns the modules that a module of the page imports."""
    if path in MADE:
        return MADE[path]
    names = re.findall(r"""(?:import|from)\s*\(?\s*["'](\.[^"']+)["']""", path.read_text(encoding="utf-8"))
    return {(path.parent / name).resolve() for name in names}


def test_no_module_imports_itself_by_way_of_others() -> None:
    known = {path: imports(path) for path in [*MODULES, *MADE]}
    while True:  # what imports only what is known to be in no circle is in none
        free = {path for path, wanted in known.items() if not wanted & known.keys()}
        if not free:
            break
        known = {path: wanted for path, wanted in known.items() if path not in free}
    assert sorted(path.name for path in known) == []


def test_a_new_file_of_the_folder_is_a_panel(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "panels").mkdir()
    for name in ("my-own.js", "buffers.js", "buffers.css"):
        (tmp_path / "panels" / name).touch()
    monkeypatch.setattr(page_files, "static", lambda: tmp_path)
    text = page_files.panels()
    assert re.findall(r'^import \* as (\w+) from "(.+)";$', text, re.MULTILINE) == [
        ("panel0", "./panels/buffers.js"),
        ("panel1", "./panels/my-own.js"),
    ]
    assert "PANELS = [panel0, panel1].flatMap" in text
    assert page_files.panel_styles() == '@import url("panels/buffers.css");\n'
