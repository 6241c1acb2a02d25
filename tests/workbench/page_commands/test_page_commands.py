"""The registry of page commands: what holds for each of them."""

from __future__ import annotations

import pickle
import re
from typing import Any

import pytest
from pydantic import ValidationError

from workbench.page_commands import COMMANDS, PageCommand, Question
from workbench.page_commands.command import page_command
from workbench.protocol import COMMAND

USUAL = {"name": "width", "memory": "memory", "value": 1, "word": "teleport", "time": 0.01, "width": 0.5, "shown": True}


def usual(kind: type[PageCommand]) -> dict[str, Any]:
    """Returns valid fields of a command: those that are required."""
    fields = {name: USUAL[name] for name, field in kind.model_fields.items() if field.is_required()}
    return {**fields, "name": "contacts"} if kind.__name__ == "ShowOverlay" else fields


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_is_validated_once_and_arrives_in_the_worker_as_it_was(name: str) -> None:
    kind = COMMANDS[name]
    command = COMMAND.validate_python({"type": name, **usual(kind)})
    assert type(command) is kind
    assert pickle.loads(pickle.dumps(command)) == command
    assert kind.__doc__
    assert re.match(r"[A-Z].*\.", kind.__doc__)
    assert issubclass(kind, Question) == (kind.carry_out is Question.carry_out)
    with pytest.raises(ValidationError, match="frozen"):
        command.type = "other"  # type: ignore[attr-defined] # pyright: ignore[reportAttributeAccessIssue]
    with pytest.raises(ValidationError, match="Extra inputs are not permitted"):
        COMMAND.validate_python({"type": name, **usual(kind), "more": 1})


def test_two_commands_of_one_name_are_refused() -> None:
    with pytest.raises(ValueError, match=r"page command 'run' is defined twice: workbench\.page_commands\.running\.Run and .*Again"):

        @page_command
        class Again(PageCommand):  # pyright: ignore[reportUnusedClass]
            """Continues the run."""

            type: Any = "run"
