"""The messages of the command `actr3d experiment --json`, one JSON object a line; see `actr3d.experiment.command`."""

from __future__ import annotations

from typing import Any

import msgspec


class ExperimentEvent(msgspec.Struct, frozen=True, kw_only=True, tag_field="event"):
    """Base of all messages."""


class ExperimentFacts(ExperimentEvent, frozen=True, kw_only=True, tag="facts"):
    """What is known of an experiment before it runs."""

    name: str
    """That of the design."""
    description: str
    trials: int
    """Their number."""
    trials_a_cell: int
    factors: dict[str, list[Any]]
    """Levels by name."""
    groups: dict[str, int]
    """Numbers of participants by name."""
    group_parameters: dict[str, dict[str, Any]] = {}
    """Values of parameters by group and name; a text for a distribution."""
    settings: dict[str, Any] = {}
    """Values of other parameters by name."""
    changed: dict[str, Any] = {}
    """The values and numbers that replace those of the design."""
    measures: list[dict[str, Any]] = []
    """The measures that the design names: name, unit, meaning, over."""
    seed: int = 0
    model: str = ""
    """The model file."""
    parameters: list[dict[str, Any]] = []
    """The parameters of the model: name, help, unit, default, choices."""


class TriedFacts(ExperimentFacts, frozen=True, kw_only=True, tag="check"):
    """The facts of an experiment of which a trial was run."""

    seconds_a_trial: float
    """Its duration on one processor [s]."""
    error: str | None = None
    """The traceback of the trial, if it failed."""


class ExperimentProgress(ExperimentEvent, frozen=True, kw_only=True, tag="progress"):
    """How far an experiment is."""

    done: int
    total: int
    failures: int
    workers: int = 0


class ExperimentEnd(ExperimentEvent, frozen=True, kw_only=True, tag="end"):
    """An experiment has ended in order: all trials have run, or it was stopped."""

    done: int
    total: int
    failures: int


AnyExperimentEvent = ExperimentFacts | TriedFacts | ExperimentProgress | ExperimentEnd
EVENTS: msgspec.json.Decoder[AnyExperimentEvent] = msgspec.json.Decoder(AnyExperimentEvent)
"""Decodes a message; other ones raise an error."""
