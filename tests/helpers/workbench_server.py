"""The workbench as users start it: the command in a separate process."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import httpx

from tests.helpers.paths import MODELS


class Served:
    """A running workbench, and a client for its requests.

    There is one client, as each new one loads all certificates. Each request has a connection of its own: on one that is kept,
    each small body waits 40 ms for the system.
    """

    def __init__(self, process: subprocess.Popen[str], lines: list[str], folder: Path) -> None:
        self.process = process
        self.lines = lines
        """What the command has printed."""
        self.folder = folder
        self.address = lines[-1]
        self.token = self.address.partition("?token=")[2]
        self.url = self.address.partition("/?")[0]
        self.port = int(self.url.rpartition(":")[2])
        self.headers = {"authorization": f"Bearer {self.token}", "x-workbench": "1", "content-type": "application/json"}
        self.client = httpx.Client(headers=self.headers, timeout=180, limits=httpx.Limits(max_keepalive_connections=0))

    def get(self, path: str, **more: Any) -> httpx.Response:
        return self.client.get(self.url + path, **more)

    def put(self, path: str, body: Any) -> httpx.Response:
        return self.client.put(self.url + path, json=body)

    def post(self, path: str, body: Any = None) -> httpx.Response:
        return self.client.post(self.url + path, json={} if body is None else body)


@contextmanager
def served(folder: Path, *options: str) -> Generator[Served]:
    """Starts the workbench with copies of some models, and ends it."""
    folder.mkdir(exist_ok=True)
    for name in ("doorway.py", "counting.py"):
        shutil.copy(MODELS / name, folder / name)
    command = [sys.executable, "-m", "workbench", str(folder), "--no-browser", *options]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as process:
        assert process.stdout is not None
        lines: list[str] = []
        while not lines or "token=" not in lines[-1]:
            line = process.stdout.readline()
            assert line, f"it did not start: {lines}"
            lines.append(line.rstrip("\n"))
        running = Served(process, lines, folder)
        try:
            yield running
        finally:
            running.client.close()
            process.terminate()
            rest = process.stdout.read()
            process.wait(30)
            assert not re.search("Traceback|Exception", rest), rest
            assert running.token not in rest  # it is printed once, as part of the address
