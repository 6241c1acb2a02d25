"""What no route can take, on every route: each says what is wrong with it, in one way, and none fails."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest

from tests.helpers.asgi_client import GATE
from tests.helpers.workbench_server import Served
from workbench.app import make_app
from workbench.auth import UPLOAD_TYPE

APP = make_app(Path("/tmp"), GATE)
DESCRIPTION: dict[str, Any] = APP.openapi()
OPERATIONS = [(method, path) for path, operations in DESCRIPTION["paths"].items() for method in operations]
HALF = r'"\ud800"'
"""A half character, as JSON can say it."""
LONG = "1" * 400
"""A whole number that no float holds; a parameter of a model may be one."""
VALUES = (HALF, f'"a{HALF[1:]}', "NaN", "1e400", LONG, f"[{HALF}, NaN]", f"{{{HALF}: {HALF}}}")
"""What stands for one value in a body."""
BODIES = (*map(str.encode, VALUES), b"1" * 5000, b"", b"{", b"\xff", b'"\xed\xa0\x80"', b"[" * 5000 + b"]" * 5000, b'{"": NaN}')
IN_ADDRESS = ("%ED%A0%80", "a%ED%A0%80.py", "%FF", "NaN", "1e400", "1" * 400, "%00")


@pytest.fixture(scope="module")
def session(server: Served) -> str:
    return server.post("/api/sessions", {"model": "doorway.py"}).json()["id"]


def resolved(schema: dict[str, Any]) -> dict[str, Any]:
    return resolved(DESCRIPTION["components"]["schemas"][schema["$ref"].rpartition("/")[2]]) if "$ref" in schema else schema


def valid(schema: dict[str, Any]) -> str:
    """Returns JSON that a field takes, as far as bodies here need any."""
    schema = resolved(schema)
    if "const" in schema:
        return json.dumps(schema["const"])
    if "oneOf" in schema:
        return '{"type": "pause"}'
    return {"string": '"counting.py"', "boolean": "false", "number": "1"}.get(schema.get("type", ""), "null")


def bodies(schema: dict[str, Any]) -> Iterator[str]:
    """Yields bodies of which one value is bad: each field in turn, of what stands in fields too."""
    schema = resolved(schema)
    for one in schema.get("oneOf", ()):
        yield from bodies(one)
    fields = schema.get("properties", {})
    for bad, inside in fields.items():
        others = [f'"{name}": {valid(fields[name])}' for name in fields if name != bad and name in {*schema.get("required", ()), "type"}]
        for value in (*VALUES, *bodies(inside)):
            yield "{" + ", ".join((*others, f'"{bad}": {value}')) + "}"
    if fields:
        yield f"{{{HALF}: NaN}}"


PLACES = ("session", "recording", "experiment", "folder", "file")


def told(answer: httpx.Response) -> None:
    """Checks that an answer is no failure, and if it is a refusal, says why in the way of all others."""
    assert answer.status_code < 500, (answer.request.url, answer.request.content[:200], answer.text)
    if answer.status_code >= 400:
        error = answer.json()
        assert error.keys() <= {"error", "result"}, error
        assert isinstance(error["error"], str)
        assert error["error"]


@pytest.mark.parametrize(("method", "path"), OPERATIONS, ids=[" ".join(operation) for operation in OPERATIONS])
def test_the_description_says_how_a_request_is_refused(method: str, path: str) -> None:
    success, refusal = DESCRIPTION["paths"][path][method]["responses"].items()
    assert (success[0][0], refusal[0]) == ("2", "default")
    assert list(resolved(refusal[1]["content"]["application/json"]["schema"])["properties"]) == ["error"]


def test_the_description_says_of_which_kinds_files_are() -> None:
    found = {
        path: list(DESCRIPTION["paths"][path]["get"]["responses"]["200"]["content"])
        for _, path in OPERATIONS
        if "/file" in path or "/report/" in path
    }
    assert found == {
        "/api/recordings/{recording}/file": [UPLOAD_TYPE, "text/csv", "text/html"],
        "/api/experiments/{experiment}/report/index.html": ["text/html"],
        "/api/experiments/{experiment}/report/{folder}/{file}": ["text/html", "image/svg+xml", "image/png", "text/csv"],
    }


@pytest.mark.daily(4)
@pytest.mark.parametrize(("method", "path"), OPERATIONS, ids=[" ".join(operation) for operation in OPERATIONS])
def test_invalid_input_is_reported(method: str, path: str, server: Served, session: str) -> None:
    operation = DESCRIPTION["paths"][path][method]
    described = operation.get("requestBody", {}).get("content", {}).get("application/json", {}).get("schema")
    here = {**dict.fromkeys(PLACES, "x"), "session": session}

    def ask(address: str, body: bytes) -> httpx.Response:
        answer = server.client.request(method, server.url + address, content=body)
        told(answer)
        return answer

    for value in IN_ADDRESS:
        ask(path.format(**dict.fromkeys(PLACES, value)), b"{}")
        for name in [parameter["name"] for parameter in operation.get("parameters", ()) if parameter["in"] == "query"]:
            ask(f"{path.format(**here)}?{name}={value}", b"{}")
    if described is not None:
        for body in (*BODIES, *(body.encode() for body in bodies(described))):
            answer = ask(path.format(**here), body)
            assert answer.status_code >= 400 or LONG.encode() in body, body


def test_pages_take_every_address(server: Served) -> None:
    for place in ("/viser/{}/", "/static/now/{}", "/{}", "/api/{}", "/viser/?token={}"):
        for value in IN_ADDRESS:
            answer = server.get(place.format(value))
            assert answer.status_code < 500, (answer.request.url, answer.text)


def test_errors_name_the_place_and_do_not_echo_the_input(server: Served) -> None:
    for path, body, status, words in (
        ("/api/sessions", "NaN", 422, "body: Input should be a valid dictionary or object"),
        ("/api/sessions", '{"model": "counting.py", "seed": 1e400}', 422, "body.seed: Input should be a finite number"),
        ("/api/sessions", f'{{"model": {HALF}}}', 422, "body.model: Input should be a valid string"),
        ("/api/sessions", f'{{"model": "counting.py", {HALF}: 1}}', 422, "body: Input should be a valid string"),
        ("/api/sessions", '{"model": "counting.py", }', 400, "the body is not JSON: "),
        ("/api/compare", '{"first": "secret"}', 422, "body.second: Field required"),
        ("/api/sessions/x/command", '{"command": {"type": "secret"}}', 422, "body.command: 'type' must be one of 'explain', 'memory', "),
        (
            "/api/sessions/x/command",
            json.dumps({"command": {"type": "command", "word": "set_buffer", "values": ["goal", "secret" * 2000]}}),
            422,
            "body.command.command.values.1: a text has at most 10,000 characters (this one has 12,000)",
        ),
        (
            "/api/sessions",
            '{"model": "counting.py", "settings": {"a": ["secret"]}}',
            422,
            "body.settings.a: must be a number, a text, true, false or null",
        ),
        (
            "/api/sessions/x/command",
            '{"command": {"type": "set", "name": "a", "value": NaN}}',
            422,
            "body.command.set.value: must be a finite",
        ),
        (
            "/api/sessions",
            f'{{"model": "counting.py", "settings": {{"a": {2**64}}}}}',
            422,
            "body.settings.a: a whole number has at most 64 bits",
        ),
        ("/api/sessions", f'{{"{"x" * 200}secret": 1}}', 422, "body.model: Field required"),
        ("/api/sessions", f'{{"model": "counting.py", "{"x" * 200}secret": 1}}', 422, "body.xxx"),
    ):
        answer = server.client.post(server.url + path, content=body.encode())
        assert answer.status_code == status
        assert answer.json()["error"].startswith(words), answer.text
        assert "secret" not in answer.text
    assert server.get("/api/recordings", params={"first": -1}).json()["error"].startswith("query.first: ")
    assert server.get("/api/nothing").json() == {"error": "Not Found"}


@pytest.mark.skipif(os.name != "posix", reason="there is no such name")
def test_a_file_whose_name_is_no_utf8_hides_no_other(server: Served) -> None:
    odd = server.folder / os.fsdecode(b"odd\xff.py")
    odd.write_text('"Odd."\n', encoding="utf-8")
    try:
        told = {model["path"]: model["problem"] for model in server.get("/api/models").json()["models"]}
        assert told["counting.py"] is None
        assert told[r"odd\udcff.py"] == "must have no invisible or invalid characters"
    finally:
        odd.unlink()
