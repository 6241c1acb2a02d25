"""What all messages of pages and programs have in common, also those that are no commands of a run."""

from __future__ import annotations

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

FilePath = Annotated[str, Field(min_length=1, max_length=400)]
"""The path of a model file inside the models folder."""


class PageMessage(BaseModel):
    """Base of everything that a page or a program sends."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)
