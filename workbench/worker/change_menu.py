"""Describes for pages the changes that a user can make in a run by hand."""

from __future__ import annotations

import inspect
import re
from functools import cache
from typing import Any

from actr3d.actr.changes import AgentChange
from actr3d.change import CHANGES, Change
from actr3d.parameter_schema import parameters_of
from actr3d.values import to_json


@cache
def change_menu(*, agents_only: bool) -> bytes:
    """Returns as JSON a list of changes, all or those of agents: word, what it is `of`, title, help, text, and the fields with units and
    bounds."""
    kinds = [kind for kind in CHANGES.values() if issubclass(kind, AgentChange) or not agents_only]
    return to_json([_described(kind) for kind in kinds]).encode()


def _described(kind: type[Change]) -> dict[str, Any]:
    fields = [
        {"name": one.name, "takes": one.takes, "required": one.required, "default": one.default, "unit": one.unit, "help": one.help}
        for one in parameters_of(kind)
    ]
    sentence = re.split(r"(?<=\.)\s", inspect.getdoc(kind) or "")[0]
    return {"word": kind.word, "of": kind.of, "title": kind.title, "help": sentence, "text": kind.text, "fields": fields}
