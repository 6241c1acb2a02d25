"""Tests of the addresses of the page's files."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from starlette.applications import Starlette
from starlette.routing import Mount

from tests.helpers.asgi_client import ask
from tests.helpers.workbench_server import Served
from workbench import page_files
from workbench.page_files import ROUTE, PageFiles
from workbench.shipped import static


def test_a_file_is_kept_until_one_is_edited(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "panels").mkdir()
    (tmp_path / "main.js").write_text("first")
    monkeypatch.setattr(page_files, "static", lambda: tmp_path)
    files = PageFiles()
    app = Starlette(routes=[Mount(ROUTE, files)])

    before = files.address()
    assert files.address() == before
    for name in ("main.js", "panels.js", "panels.css", "trace_kinds.js"):
        found = ask(app, f"{before}/{name}")
        assert (found.status, found.headers["cache-control"]) == (200, "private, max-age=31536000, immutable")
    assert ask(app, f"{before}/missing.js").status == 404

    (tmp_path / "main.js").write_text("second, longer")
    after = files.address()
    assert after != before
    assert ask(app, f"{after}/main.js").body == b"second, longer"
    stale = ask(app, f"{before}/main.js")  # an open page loads a file late: it gets that of today, and does not keep it
    assert (stale.body, "cache-control" in stale.headers) == (b"second, longer", False)

    (tmp_path / "panels" / "new.js").touch()
    assert files.address() not in (before, after)
    assert files.with_versions('src="/static/main.js"') == f'src="{files.address()}/main.js"'


def test_the_page_names_the_version_of_its_files(server: Served) -> None:
    addresses = re.findall('(?:src|href)="(/static/[^"]+)"', server.get("/").text)
    assert sorted(re.sub("/static/[0-9a-f]{16}/", "", address) for address in addresses) == ["icon.svg", "main.js", "style.css"]
    for address in addresses:
        assert "immutable" in server.get(address).headers["cache-control"]
    assert server.get("/static/0123456789abcdef/main.js").headers["cache-control"] == "no-store"


def test_a_button_that_can_be_disabled_is_one_that_keeps_the_focus() -> None:
    own = [path for path in static().rglob("*.js") if "vendor" not in path.parts and path.name != "button.js"]
    plain = re.compile(r"<button(?:\$\{(?:[^{}]|\{[^{}]*\})*\}|[^>$])*\sdisabled=")
    assert [path.name for path in own if plain.search(path.read_text(encoding="utf-8"))] == []
    assert plain.search("<button class=${a ? `${b}` : c} onClick=${() => go()} disabled=${off}>")
