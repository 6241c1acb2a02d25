"""Checks whether a recording can be run again; runs nothing of it."""

from __future__ import annotations

from actr3d.errors import RecordingError, UntrustedError
from actr3d.recording import Recorded
from actr3d.recording.facts import FACTS, fact_of
from actr3d.recording.schema import versions


def check_replayable(recorded: Recorded, *, trust: bool, any_version: bool) -> None:
    """Checks that a recording can be run again, and that its code may be run; reads the whole file.

    Args:
        recorded: The recording.
        trust: Whether it may be run even if this installation did not make it.
        any_version: Whether the versions of Python, MuJoCo and others may differ from those of the recording.

    Raises:
        UntrustedError: If the recording was made elsewhere and `trust` is false.
        RecordingError: If the file is damaged, lacks something, or holds nothing to compare, or versions differ.
    """
    recorded.check()
    _check_facts(recorded)
    if not any_version:
        _check_versions(recorded.facts["versions"])
    if not (recorded.finished or recorded.state_count or recorded.event_count):
        raise RecordingError(
            f"the recording '{recorded.path}' holds nothing to compare: its run was left or interrupted before anything was written"
        )
    if not (trust or recorded.made_here):
        raise UntrustedError(
            f"'{recorded.path}' was not made by this installation, and a replay runs the code that it holds; "
            "if you trust where it comes from, call replay(recorded, trust=True)"
        )


def _check_facts(recorded: Recorded) -> None:
    facts = recorded.facts
    kinds = ("simulation", "built") if facts["kind"] == "simulation" and facts.get("built") else (facts["kind"],)
    needed = [name for kind in kinds for name, fact in FACTS.items() if kind in fact.needed_by]
    missing = [f"'{name}'" for name in needed if name not in facts]
    if not missing and "file" in needed and facts["file"] not in facts["sources"]:
        missing = [f"the source of '{facts['file']}'"]
    if missing:
        raise RecordingError(f"the recording '{recorded.path}' cannot be run again: it lacks {', '.join(missing)}")
    if kinds != ("simulation",):  # the program that makes one may give any facts
        unknown = sorted(name for name in facts if (fact := fact_of(name)) is None or fact.only not in (None, *kinds))
        if unknown:
            names = ", ".join(f"'{name}'" for name in unknown)
            raise RecordingError(f"the recording '{recorded.path}' cannot be run again: such a run cannot have the fact {names}")


def _check_versions(then: dict[str, str]) -> None:
    now = versions()
    different = [f"{name} {then.get(name)} then, {now.get(name)} now" for name in sorted({*then, *now}) if then.get(name) != now.get(name)]
    if different:
        raise RecordingError(f"the recording was made with other versions, which alone may cause differences: {'; '.join(different)}")
