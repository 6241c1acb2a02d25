"""Builds the wheel, installs it into an empty environment elsewhere, and starts the workbench there: `uv run python -m tests.wheel`.

Packages come from the user's cache where they are there. Its exit code is 1 where anything is missing.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import time
import urllib.request
import zipfile
from pathlib import Path
from typing import Any

from tests.helpers.manual_site import ROOT, SITE, built_manual

PATIENCE = 300.0
"""Maximum time that a test waits for the workbench to start, or for a model to end [s]: the camera is compiled there for the first time."""


def main() -> int:
    """Does it; returns 0 where all is there."""
    begin = time.monotonic()
    with tempfile.TemporaryDirectory() as made:
        folder = Path(made)
        built_manual()
        _run("uv", "build", "--quiet", "--wheel", "--out-dir", str(folder / "dist"), str(ROOT))
        (wheel,) = (folder / "dist").glob("*.whl")
        _complete(wheel)
        environment = folder / "environment"
        _run("uv", "venv", "--quiet", "--python", sys.executable, str(environment))
        wanted = ["--constraint", _constraints(folder), str(wheel)]
        _run("uv", "pip", "install", "--quiet", "--python", str(environment), *wanted)
        _say(f"installed after {time.monotonic() - begin:.0f} s")
        _start(environment, folder)
    _say(f"the wheel holds all that the workbench needs; {time.monotonic() - begin:.0f} s")
    return 0


def _complete(wheel: Path) -> None:
    """Compares what is in the wheel with what is in the repository."""
    with zipfile.ZipFile(wheel) as archive:
        inside = set(archive.namelist())
    tracked = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True).stdout.splitlines()
    places = {"static/": "workbench/static/", "models/": "actr3d/models/", "actr3d/": "actr3d/", "workbench/": "workbench/"}
    for name in tracked:
        for here, there in places.items():
            if name.startswith(here) and not (name.endswith(".gitignore") or there + name.removeprefix(here) in inside):
                raise SystemExit(f"the wheel lacks {name}")
    for file in SITE.rglob("*"):
        if file.is_file() and f"workbench/manual/{file.relative_to(SITE).as_posix()}" not in inside:
            raise SystemExit(f"the wheel lacks the page {file} of the manual")


def _constraints(folder: Path) -> str:
    import tomllib

    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    path = folder / "constraints.txt"
    path.write_text("\n".join(project["tool"]["uv"]["constraint-dependencies"]), encoding="utf-8")
    return str(path)


def _start(environment: Path, folder: Path) -> None:
    """Starts the workbench in an empty folder, with an empty home, and runs a shipped model there."""
    home = folder / "home"
    home.mkdir()
    outer = {name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "VIRTUAL_ENV", "UV_"))}
    command = [str(environment / "bin" / "workbench"), "--no-browser"]
    begin = time.monotonic()
    with subprocess.Popen(command, cwd=home, env={**outer, "HOME": str(home)}, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        try:
            lines: list[str] = []
            while not lines or "token=" not in lines[-1]:
                lines.append(process.stdout.readline().strip())
                if not lines[-1]:
                    raise SystemExit(f"the workbench did not start: {lines}")
            _say(f"started after {time.monotonic() - begin:.1f} s")
            _use(lines[-1], home)
        finally:
            process.terminate()


def _use(address: str, home: Path) -> None:
    url, _, token = address.partition("/?token=")

    def ask(path: str, body: Any = None) -> bytes:
        headers = {"authorization": f"Bearer {token}", "x-workbench": "1", "content-type": "application/json"}
        request = urllib.request.Request(url + path, None if body is None else json.dumps(body).encode(), headers)
        with urllib.request.urlopen(request, timeout=PATIENCE) as answer:
            return answer.read()

    page = ask("/").decode()
    if "<html" not in page:
        raise SystemExit("there is no page")
    files = page.partition('src="')[2].partition("main.js")[0]
    for file in (ROOT / "static").rglob("*"):
        if file.is_file() and ask(f"{files}{file.relative_to(ROOT / 'static').as_posix()}") != file.read_bytes():
            raise SystemExit(f"the page's {file.name} is another")
    if ask("/manual/workbench/buffers/") != (SITE / "workbench" / "buffers" / "index.html").read_bytes():
        raise SystemExit("the manual is another")
    listed = json.loads(ask("/api/models"))
    names = {model["path"] for model in listed["models"]}
    if not {"aperture_passage.py", "doorway.py"} <= names or not Path(listed["folder"]).is_relative_to(home.resolve()):
        raise SystemExit(f"the models are not there: {listed}")
    session = json.loads(ask("/api/sessions", {"model": "doorway.py", "seed": 1, "run": True}))["id"]
    end = time.monotonic() + PATIENCE
    state: dict[str, Any] | None = None
    while state is None or state["status"] != "ended":
        if time.monotonic() > end:
            raise SystemExit(f"the model did not end: {state}")
        time.sleep(0.1)
        state = json.loads(ask(f"/api/sessions/{session}"))["state"]
    if state["time"] != 6.8:
        raise SystemExit(f"the model ended at another time: {state['time']}")


def _run(*command: str) -> None:
    subprocess.run(command, check=True)


def _say(text: str) -> None:
    sys.stderr.write(text + "\n")


if __name__ == "__main__":
    sys.exit(main())
