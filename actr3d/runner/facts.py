"""The facts with which runs are recorded, and their comparison with those of a replay."""

from __future__ import annotations

import json
from collections.abc import Collection, Mapping
from typing import Any

from actr3d.recording.facts import OF_END
from actr3d.values import shortened

SHOWN = 200
"""The maximum length of a value in a message [characters]."""


def program_facts(file: str, source: str, seed: int | str | None, until: float | None) -> dict[str, Any]:
    """Returns the facts that the recording of a program begins with."""
    return {"kind": "program", "file": file, "sources": {file: source}, "seed": seed, "until": until}


def built_facts(
    file: str, source: str, parameters: Mapping[str, Any], seed: int | str, until: float | None, helpers: Mapping[str, Any]
) -> dict[str, Any]:
    """Returns the facts of a model file that builds a simulation; `Simulation.facts` returns those of the simulation.

    Args:
        file: The name of the file.
        source: Its text.
        parameters: The values of all its parameters.
        seed: The seed of the program.
        until: The limit of its runs [s]; None for none.
        helpers: The helper modules that it has loaded while it built the simulation.
    """
    facts = {"file": file, "sources": {file: source}, "parameters": parameters, "built": True}
    return {**facts, "program_seed": seed, "until": until, "helpers": helpers}


def first_difference(recorded: Mapping[str, Any], repeated: Mapping[str, Any], ignored: Collection[str]) -> str | None:
    """Returns the first fact that differs; a missing fact is the same as null.

    Args:
        recorded: The recorded facts.
        repeated: Those of the repeated run.
        ignored: The names of facts that are not compared.
    """
    names = sorted({*recorded, *repeated} - {*ignored}, key=lambda name: (OF_END.index(name) if name in OF_END else len(OF_END), name))
    for name in names:
        was, is_now = json.dumps(recorded.get(name)), json.dumps(repeated.get(name))
        if json.loads(was) != json.loads(is_now):
            return f"the fact '{name}'; recorded: {shortened(was, SHOWN)}; now: {shortened(is_now, SHOWN)}"
    return None
