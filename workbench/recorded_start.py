"""Reads what a recorded run began with and which commands users gave: all that is needed to run it again in a session."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, Self

import msgspec

from actr3d.errors import RecordingError
from actr3d.recording import Recorded
from actr3d.runner.program_changes import of_user
from workbench.run_facts import seed_of


class RecordedStart(msgspec.Struct, frozen=True, kw_only=True):
    """Holds what a recorded run began with."""

    recording: str
    """The path of the recording."""
    made_here: bool
    """Whether this installation made the recording and nobody has changed it since; only then has its code been run here before."""
    file: str
    """The path of the model file."""
    source: str
    seed: int | str
    parameters: dict[str, Any]
    helpers: dict[str, tuple[str, str]]
    """The file and text of each helper module, by name."""
    commands: list[tuple[int, int, dict[str, Any]]]
    """The commands of users: the run, the tick after which each was given (for an agent without a simulation: the time [us]), and the
    command."""

    def to_json(self) -> str:
        """Returns it as JSON, including numbers and texts that strict JSON does not allow."""
        return json.dumps(msgspec.structs.asdict(self))

    @classmethod
    def from_json(cls, text: bytes) -> Self:
        """Parses the JSON that `to_json` returned.

        Raises:
            RecordingError: If a worker cannot receive its values.
        """
        try:
            start = msgspec.convert(json.loads(text), cls)
            msgspec.msgpack.encode(start)
        except RecursionError:
            raise RecordingError("the recording cannot be read: its values are nested too deeply") from None
        except UnicodeEncodeError as error:
            raise RecordingError(f"the recording cannot be opened: a text in it cannot be encoded ({error.reason})") from None
        except OverflowError:
            raise RecordingError("the recording cannot be opened: a whole number in it has more than 64 bits") from None
        return start


def recorded_start_of(path: Path) -> RecordedStart:
    """Returns what the run of a recording began with.

    Raises:
        RecordingError: If it cannot be read, or does not name the model file that made it.
        ValidationError: If its commands or facts are not valid for a run.
    """
    with Recorded(path) as recorded:
        facts = recorded.facts
        file = facts.get("file")
        if not isinstance(file, str) or file not in facts.get("sources", {}):
            raise RecordingError("the recording does not say which model file made it")
        recorded_commands = list(recorded.commands())
        facts = {
            "recording": str(path),
            "made_here": recorded.made_here,
            "file": file,
            "source": facts["sources"][file],
            "seed": seed_of(facts),
            "parameters": facts.get("parameters", {}),
            "helpers": facts.get("helpers", {}),
            "commands": recorded_commands if facts["kind"] == "simulation" else of_user(recorded_commands),
        }
    return msgspec.convert(facts, RecordedStart)
