"""The REST interface for questions about the text of a model: completion, documentation, definitions, renaming, formatting."""

from __future__ import annotations

from fastapi import APIRouter, Request
from fastapi.responses import Response

from actr3d.values import to_json
from workbench.language.answers import LanguageError
from workbench.language.language_question import LanguageQuestion
from workbench.language.language_server import LanguageServer
from workbench.routes import json_response

router = APIRouter(prefix="/api")


@router.post("/language")
async def language(request: Request, body: LanguageQuestion) -> Response:
    """Answers a question about a text, by reading it: neither the text nor the files beside it are executed.

    A question without an answer is usual while someone writes, for example if reading takes too long: then `unanswered` says why, and
    `line` which line of the text is the reason, if one is.
    """
    request.app.state.sessions.folder.locate(body.path)
    server: LanguageServer = request.app.state.language
    try:
        answer = await server.ask(body.model_dump_json().encode())
    except LanguageError as error:
        answer = to_json({"unanswered": str(error), "line": error.line}).encode()
    return json_response(answer)
