"""The REST interface for questions about the text of a model: completion, documentation, definitions, renaming, formatting."""

from __future__ import annotations

from typing import Annotated, Literal

from fastapi import APIRouter, Request
from fastapi.responses import Response
from pydantic import Field

from actr3d.values import to_json
from workbench.language.answers import LanguageError
from workbench.language.language_server import LONGEST_TEXT, LanguageServer
from workbench.page_commands import PageMessage
from workbench.routes import FilePath, json_response

router = APIRouter(prefix="/api")


class AskAboutText(PageMessage):
    """A question about a text, which may be incomplete and need not be that of its file."""

    ask: Literal["complete", "document item", "document", "signature", "define", "rename", "format"]
    path: FilePath
    text: Annotated[str, Field(max_length=LONGEST_TEXT)]
    at: int = Field(default=0, ge=0, le=2 * LONGEST_TEXT)
    """The position, in UTF-16 code units from the start."""
    name: Annotated[str, Field(max_length=400)] = ""
    """The label of a completion, or the new name; without one, `rename` returns what would be renamed."""


@router.post("/language")
async def language(request: Request, body: AskAboutText) -> Response:
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
