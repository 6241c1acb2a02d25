"""The workbench serves the built manual, and says how to build it where there is none."""

from __future__ import annotations

import time
from pathlib import Path

import pytest

from tests.helpers.asgi_client import COOKIE, GATE, HOST, ask
from workbench import app, built_manual


def test_the_built_manual_is_served(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    page = tmp_path / "site" / "workbench" / "buffers" / "index.html"
    page.parent.mkdir(parents=True)
    page.write_text("<h1>Buffers</h1>", encoding="utf-8")
    monkeypatch.setattr(app, "manual", lambda: tmp_path / "site")
    made = app.make_app(tmp_path / "models", GATE)
    assert ask(made, "/manual/workbench/buffers/", HOST).status == 401
    answer = ask(made, "/manual/workbench/buffers/", HOST, COOKIE)
    assert (answer.status, answer.body) == (200, b"<h1>Buffers</h1>")
    assert "script-src 'self';" in answer.headers["content-security-policy"]


def test_a_shipped_model_has_a_page_in_the_built_manual(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    page = tmp_path / "models" / "tutorial-counting" / "index.html"
    page.parent.mkdir(parents=True)
    page.write_text("<h1>Counting</h1>", encoding="utf-8")
    monkeypatch.setattr(built_manual, "manual", lambda: tmp_path)
    assert built_manual.manual_page("tutorial/counting.py") == "/manual/models/tutorial-counting/"
    assert built_manual.manual_page("own.py") is None
    assert built_manual.manual_page("\0.py") is None
    monkeypatch.setattr(built_manual, "manual", lambda: None)
    assert built_manual.manual_page("tutorial/counting.py") is None


def test_without_a_built_manual_the_answer_says_how_to_build_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(app, "manual", lambda: None)
    answer = ask(app.make_app(tmp_path, GATE), "/manual/", HOST, COOKIE)
    assert answer.status == 404
    assert b"uv run mkdocs build" in answer.body


def test_a_manual_that_is_built_while_the_workbench_runs_is_served(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    site = tmp_path / "site"
    monkeypatch.setattr(app, "manual", lambda: site if site.is_dir() else None)
    made = app.make_app(tmp_path / "models", GATE)
    assert "uv run mkdocs build" in ask(made, "/manual/", HOST, COOKIE).body.decode()
    site.mkdir()
    (site / "index.html").write_text("<h1>Manual</h1>", encoding="utf-8")
    assert ask(made, "/manual/", HOST, COOKIE).body == b"<h1>Manual</h1>"


def wait_until_built() -> None:
    end = time.monotonic() + 60
    while built_manual.is_being_built():
        assert time.monotonic() < end
        time.sleep(0.05)


def test_the_manual_of_a_copy_of_the_repository_is_built_in_the_background(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "docs").mkdir()
    (tmp_path / "docs" / "index.md").write_text("# Manual of a copy", encoding="utf-8")
    (tmp_path / "mkdocs.yml").write_text("site_name: Copy", encoding="utf-8")
    site = tmp_path / "build" / "site"
    monkeypatch.setattr(built_manual, "PACKAGE", tmp_path / "workbench")
    monkeypatch.setattr(built_manual, "SITE", site)
    made = app.make_app(tmp_path / "models", GATE)
    built_manual.build_manual()
    assert "is being built" in ask(made, "/manual/", HOST, COOKIE).body.decode()
    wait_until_built()
    assert b"Manual of a copy" in ask(made, "/manual/", HOST, COOKIE).body
    assert [one.name for one in site.parent.iterdir()] == ["site"]


def test_a_manual_that_cannot_be_built_is_not_waited_for(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "mkdocs.yml").write_text("site_name: [", encoding="utf-8")
    monkeypatch.setattr(built_manual, "PACKAGE", tmp_path / "workbench")
    monkeypatch.setattr(built_manual, "SITE", tmp_path / "build" / "site")
    built_manual.build_manual()
    wait_until_built()
    assert "uv run mkdocs build" in ask(app.make_app(tmp_path / "models", GATE), "/manual/", HOST, COOKIE).body.decode()
