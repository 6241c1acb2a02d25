"""Every route under several clients at once, while what they ask for is renamed, deleted and made again.

Each answer is whole, or a clear error.

The routes are those of the application's own description, and requests are made from it: a new route is asked as soon as it is there.
"""

from __future__ import annotations

import itertools
import json
import os
import random
import shutil
import sqlite3
import time
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing
from pathlib import Path
from typing import Any

import httpx
import pytest

from actr3d.experiment.report.command import write_report
from tests.helpers.experiments import write_experiment
from tests.helpers.reports import store_rows
from tests.helpers.workbench_server import Served, served
from tests.workbench.test_bad_input import DESCRIPTION, OPERATIONS, resolved, valid
from workbench.experiment_folder import ExperimentFolder

pytestmark = pytest.mark.long

SOURCE = "counting.py"
RECORDINGS = tuple(f"r{number}" for number in range(5))
MODELS = tuple(f"m{number}.py" for number in range(3))
EXPERIMENTS = tuple(f"e{number}" for number in range(3))
COLUMNS = {"x": "n", "measure": "rt"}
CLEAR = {400, 404, 409, 415, 422}
"""What an error may be called; 500 is one of the server."""


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    folder = tmp_path_factory.mktemp("storm") / "models"
    folder.mkdir()
    write_experiment(folder)
    with served(folder) as running:
        yield running


@pytest.fixture(scope="module")
def whole(server: Served) -> Path:
    """A recording of 0.5 s of the doorway, from which all others are copied."""
    session = server.post("/api/sessions", {"model": "doorway.py", "seed": 1}).json()["id"]
    server.post(f"/api/sessions/{session}/command", {"command": {"type": "step", "ticks": 50}})
    while (server.get(f"/api/sessions/{session}").json()["state"] or {"tick": 0})["tick"] < 50:
        time.sleep(0.05)
    name = server.get(f"/api/sessions/{session}").json()["session"]["recording"]
    server.post(f"/api/sessions/{session}/close")
    folder = server.folder / ".workbench" / "recordings"
    return (folder / f"{name}.sqlite").rename(server.folder / "whole.sqlite")


@pytest.fixture(scope="module")
def experiment(server: Served) -> Path:
    """A small experiment with its report, from which all others are copied."""
    design = f"{server.folder / 'counting_design.py'}:counting"
    folder = store_rows(server.folder.parent / "experiment", design, lambda trial: {"rt": 0.1 * trial.number, "luck": 0.5})
    write_report(folder)
    ExperimentFolder(folder).seal()
    assert ExperimentFolder(folder).made_here
    return folder


class Storm:
    """Asks everything of a server, and renames, deletes and makes again what it asks for.

    Args:
        server: The server.
        whole: The recording that is copied.
        experiment: The experiment that is copied.
        seed: Of what is chosen at random.
    """

    def __init__(self, server: Served, whole: Path, experiment: Path, seed: int) -> None:
        self._server = server
        self._whole = whole
        self._experiment = experiment
        self._report = [path.relative_to(experiment / "report") for path in experiment.glob("report/*/*")]
        self._random = random.Random(seed)
        self._client = httpx.Client(base_url=server.url, headers=server.headers, timeout=120)
        self.counts: Counter[tuple[str, int]] = Counter()
        self.problems: list[str] = []

    def blow(self, rounds: int) -> None:
        """Sends each request so many times, in any order."""
        for _ in range(rounds):
            for method, path in self._random.sample(OPERATIONS, len(OPERATIONS)):
                self._make_again()
                for query in self._queries(method, path):
                    self._ask(method, path, query)
        self._client.close()

    def _make_again(self) -> None:
        """Puts some recording, experiment and model where none is, as a new run does."""
        self._copy_experiment(self._server.folder / ".workbench" / "experiments" / self._random.choice(EXPERIMENTS))
        folder = self._server.folder / ".workbench" / "recordings"
        beside = folder / f".{self._random.random()}"
        shutil.copy(self._whole, beside)
        beside.rename(folder / f"{self._random.choice(RECORDINGS)}.sqlite")
        model = self._server.folder / self._random.choice(MODELS)
        if not model.exists():
            model.write_bytes((self._server.folder / SOURCE).read_bytes())

    def _copy_experiment(self, to: Path) -> None:
        beside = to.with_name(f".{self._random.random()}")
        shutil.copytree(self._experiment, beside)
        try:
            beside.rename(to)
        except OSError:  # there is one already
            shutil.rmtree(beside)

    def _ask(self, method: str, path: str, query: dict[str, str]) -> None:
        operation = DESCRIPTION["paths"][path][method]
        session = self._random.choice(self._client.get("/api/sessions").json()["sessions"] or [{"id": "none"}])["id"]
        file = self._random.choice(self._report)
        names = {"recording": self._random.choice(RECORDINGS), "experiment": self._random.choice(EXPERIMENTS)}
        place = path.format(**names, session=session, folder=file.parent, file=file.name)
        body: Any = None if method == "get" else {}
        content = operation.get("requestBody", {}).get("content", {})
        if "application/json" in content:
            body = self._body(path, content["application/json"]["schema"])
        try:
            answer = self._client.request(method, place, params=query, json=body)
        except httpx.HTTPError as error:
            self.problems.append(f"{method} {place} {query}: {type(error).__name__}: {error}")
            return
        self.counts[f"{method} {path}", answer.status_code] += 1
        told = self._problem(answer) if "{file}" not in path or not answer.is_success else self._cut(answer, file)
        if told:
            self.problems.append(f"{method} {place} {query} {body}: {answer.status_code} {told}")

    def _problem(self, answer: httpx.Response) -> str:
        """Says what is not as it should be; nothing where all is."""
        if not answer.is_success:
            clear = (
                answer.status_code in CLEAR and set(answer.json()) - {"result"} == {"error"} and str(self._server.folder) not in answer.text
            )
            return "" if clear else answer.text[:300]
        if int(answer.headers["content-length"]) != len(answer.content):
            return "it is not as long as it says"
        kind = answer.headers["content-type"].partition(";")[0]
        if kind == "application/json":
            answer.json()
        elif kind == "application/vnd.sqlite3":
            with closing(sqlite3.connect(":memory:")) as file:
                file.deserialize(answer.content)
                return "" if file.execute("PRAGMA integrity_check").fetchone() == ("ok",) else "it is damaged"
        elif kind == "text/csv":
            return "" if answer.content.count(b"\r\n") > 50 and answer.content.endswith(b"\r\n") else "it is cut off"
        elif kind == "text/html":
            return "" if answer.text.rstrip().endswith("</html>") else "it is cut off"
        return ""

    def _cut(self, answer: httpx.Response, file: Path) -> str:
        return "" if answer.content == (self._experiment / "report" / file).read_bytes() else "it is not the file of the report"

    def _queries(self, method: str, path: str) -> Iterator[dict[str, str]]:
        """Yields what stands after the address: each choice where there are some."""
        known = [one for one in DESCRIPTION["paths"][path][method].get("parameters", []) if one["in"] == "query"]
        needed = {one["name"]: COLUMNS.get(one["name"]) or self._random.choice(MODELS) for one in known if one["required"]}
        chosen = [[(one["name"], value) for value in one["schema"]["enum"]] for one in known if "enum" in one["schema"]]
        for some in itertools.product(*chosen):
            yield {**needed, **dict(some)}

    def _body(self, path: str, schema: dict[str, Any]) -> Any:
        schema = resolved(schema)
        required = {name: json.loads(valid(schema["properties"][name])) for name in schema.get("required", [])}
        own = {"path": MODELS, "model": (*MODELS, SOURCE), "to": MODELS, "first": RECORDINGS, "second": RECORDINGS}
        chosen = {name: self._random.choice(values) for name, values in own.items() if name in required}
        return {**required, **chosen, **({"text": "x = 1\n"} if "text" in required else {})}


@pytest.mark.slow
def test_every_answer_is_whole_or_a_clear_error(server: Served, whole: Path, experiment: Path) -> None:
    clients, rounds = (4, 3) if os.environ.get("EXPLORE") else (2, 1)
    storms = [Storm(server, whole, experiment, seed) for seed in range(clients)]
    with ThreadPoolExecutor(clients) as pool:
        list(pool.map(Storm.blow, storms, [rounds] * clients))
    problems = [problem for storm in storms for problem in storm.problems]
    assert not problems, "\n".join(problems)
    counts = sum((storm.counts for storm in storms), Counter[tuple[str, int]]())
    assert {name for name, _ in counts} == {f"{method} {path}" for method, path in OPERATIONS}
    if clients > 3:  # whether others than GET succeed is a matter of chance here
        answered = {name for name, status in counts if status < 300}
        assert {f"{method} {path}" for method, path in OPERATIONS if method == "get"} <= answered
