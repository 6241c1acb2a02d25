"""The questions of a page about a text, as the server and the process that answers them read them."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from workbench.page_message import FilePath, PageMessage

LONGEST_TEXT = 200_000
"""Maximum length of a text that is read [characters]."""


class LanguageQuestion(PageMessage):
    """A question about a text, which may be incomplete and need not be that of its file."""

    ask: Literal["complete", "document item", "document", "signature", "define", "rename", "format"]
    path: FilePath
    """The model file inside the folder."""
    text: Annotated[str, Field(max_length=LONGEST_TEXT)]
    at: int = Field(default=0, ge=0, le=2 * LONGEST_TEXT)
    """The position: the number of UTF-16 code units before it, as the page counts."""
    name: Annotated[str, Field(max_length=400)] = ""
    """The label of a completion, or the new name; without one, `rename` returns what would be renamed."""
