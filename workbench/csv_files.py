"""Writes recordings as CSV: the events, and the physics with one column for each number of MuJoCo's state."""

from __future__ import annotations

import csv
from array import array
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import mujoco
from mujoco import MjModel, mjtJoint, mjtState

from actr3d.clock import seconds
from actr3d.errors import RecordingError
from actr3d.recording import Recorded
from actr3d.values import to_json
from actr3d.world.compiled import from_bytes, from_text
from workbench.recorded_simulations import facts_of_simulation

_FREE, _BALL, _SLIDE = (int(kind) for kind in (mjtJoint.mjJNT_FREE, mjtJoint.mjJNT_BALL, mjtJoint.mjJNT_SLIDE))
_TURN = ("qw", "qx", "qy", "qz")
Names = Iterator[str]


def write_events_csv(path: Path, to: Path) -> None:
    """Writes a recording's events: time, source, kind, data as JSON.

    Raises:
        RecordingError: If the recording cannot be read.
        OSError: If the file cannot be written.
    """
    with Recorded(path) as recorded:
        rows = ((event.time, event.source, event.kind, to_json(event.data)) for event in recorded.events())
        _write(to, ("time [s]", "source", "kind", "data"), rows)


def write_states_csv(path: Path, to: Path) -> None:
    """Writes the physics of a recording: one row per tick with all numbers of MuJoCo's integration state, and the contacts in the tick.

    The columns are named after joints, actuators and bodies if the recording holds its compiled scene; otherwise they are numbered.
    For a program, which may run several simulations, the first column is the number of the run, and each run begins with its own row of
    column names.

    Raises:
        RecordingError: If the recording cannot be read, or has no states.
        OSError: If the file cannot be written.
    """
    with Recorded(path) as recorded:
        if recorded.state_count == 0:
            raise RecordingError("the recording has no states: no simulation has run in it")
        _write(to, None, _state_rows(recorded))


def _state_rows(recorded: Recorded) -> Iterator[tuple[Any, ...]]:
    period: int | None = recorded.facts.get("period_us")
    time_columns = ("run", "tick") if period is None else ("time [s]",)
    for run, tick, state, _, contacts in recorded.states():
        numbers = array("d", state)
        if tick == 0:
            facts = facts_of_simulation(recorded, run)
            names = [] if facts is None else state_columns(from_bytes(from_text(facts["compiled"])))
            known = names if len(names) == len(numbers) else [f"state_{number}" for number in range(len(numbers))]
            yield *time_columns, *known, "contacts"
        listed = to_json([(*contact, force) for contact, force in contacts.items()]) if contacts else ""
        times = (run, tick) if period is None else (seconds(tick * period),)
        yield *times, *numbers, listed


def _write(to: Path, head: tuple[str, ...] | None, rows: Iterable[tuple[Any, ...]]) -> None:
    with to.open("w", encoding="utf-8", errors="backslashreplace", newline="") as file:
        writer = csv.writer(file)
        if head is not None:
            writer.writerow(head)
        writer.writerows(map(_harmless, rows))


def _harmless(row: tuple[Any, ...]) -> list[Any]:
    """Returns a row in which no text can be read as a formula by a spreadsheet."""
    return [f"'{value}" if isinstance(value, str) and value[:1] in ("=", "+", "-", "@", "\t", "\r") else value for value in row]


# -- the names of columns


def state_columns(model: MjModel) -> list[str]:
    """Returns the names of the numbers in MuJoCo's integration state, in order: the field of `MjData`, its object, and its unit.

    Source: `mj_getState` and `mjtState` in MuJoCo's documentation.
    """
    known: dict[int, Iterable[str]] = {
        int(mjtState.mjSTATE_TIME): ["mujoco time [s]"],
        int(mjtState.mjSTATE_QPOS): _positions(model),
        int(mjtState.mjSTATE_QVEL): _degrees(model, "qvel", ("v", "m/s"), ("w", "rad/s")),
        int(mjtState.mjSTATE_ACT): _of_actuators(model, "act", model.actuator_actadr, model.actuator_actnum),
        int(mjtState.mjSTATE_WARMSTART): _degrees(model, "qacc_warmstart", ("a", "m/s^2"), ("alpha", "rad/s^2")),
        int(mjtState.mjSTATE_CTRL): _of_actuators(model, "ctrl", model.actuator_ctrladr, model.actuator_ctrlnum),
        int(mjtState.mjSTATE_QFRC_APPLIED): _degrees(model, "qfrc_applied", ("f", "N"), ("t", "N m")),
        int(mjtState.mjSTATE_XFRC_APPLIED): _forces(model),
        int(mjtState.mjSTATE_EQ_ACTIVE): (f"eq_active {_name(model.equality(n), 'equality', n)}" for n in range(model.neq)),
        int(mjtState.mjSTATE_MOCAP_POS): _of_mocap(model, "mocap_pos", ("x [m]", "y [m]", "z [m]")),
        int(mjtState.mjSTATE_MOCAP_QUAT): _of_mocap(model, "mocap_quat", _TURN),
    }
    columns: list[str] = []
    for number in range(int(mjtState.mjNSTATE)):
        part = 1 << number
        if part & int(mjtState.mjSTATE_INTEGRATION):
            size, names = mujoco.mj_stateSize(model, part), list(known.get(part, ()))
            word = mjtState(part).name.removeprefix("mjSTATE_").lower()
            columns += names if len(names) == size else [f"{word} {place}" for place in range(size)]
    return columns


def _name(item: Any, kind: str, number: int) -> str:
    """Returns the name of a joint, body, ...; without a name, its kind and number."""
    return str(item.name) or f"{kind} {number}"


def _positions(model: MjModel) -> Names:
    for number in range(model.njnt):
        name, kind = _name(model.joint(number), "joint", number), int(model.jnt_type[number])
        if kind == _FREE:
            yield from (f"qpos {name} {axis} [m]" for axis in "xyz")
        if kind in (_FREE, _BALL):
            yield from (f"qpos {name} {part}" for part in _TURN)
        else:
            yield f"qpos {name} [{'m' if kind == _SLIDE else 'rad'}]"


def _degrees(model: MjModel, word: str, linear: tuple[str, str], angular: tuple[str, str]) -> Names:
    """Yields the column names of a field with one number per degree of freedom.

    Args:
        model: The compiled scene.
        word: The name of the field.
        linear: The prefix of the axis, and the unit, of a number that moves a free joint along an axis.
        angular: The same for a rotation about an axis.
    """
    for number in range(model.njnt):
        name, kind = _name(model.joint(number), "joint", number), int(model.jnt_type[number])
        if kind == _FREE:
            yield from (f"{word} {name} {linear[0]}{axis} [{linear[1]}]" for axis in "xyz")
        if kind in (_FREE, _BALL):
            yield from (f"{word} {name} {angular[0]}{axis} [{angular[1]}]" for axis in "xyz")
        else:
            yield f"{word} {name} [{(linear if kind == _SLIDE else angular)[1]}]"


def _of_actuators(model: MjModel, word: str, begins: Any, counts: Any) -> Names:
    """Yields the column names of a field in which each actuator has `counts` numbers from index `begins` on; -1 if it has none."""
    order = sorted((int(begins[number]), number) for number in range(model.nactuator) if int(counts[number]) > 0)
    for _, number in order:
        name, count = _name(model.actuator(number), "actuator", number), int(counts[number])
        yield from [f"{word} {name}"] if count == 1 else [f"{word} {name} {place}" for place in range(count)]


def _forces(model: MjModel) -> Names:
    for number in range(model.nbody):
        name = _name(model.body(number), "body", number)
        yield from (f"xfrc_applied {name} f{axis} [N]" for axis in "xyz")
        yield from (f"xfrc_applied {name} t{axis} [N m]" for axis in "xyz")


def _of_mocap(model: MjModel, word: str, parts: tuple[str, ...]) -> Names:
    moved = sorted((int(model.body_mocapid[number]), number) for number in range(model.nbody) if model.body_mocapid[number] >= 0)
    for _, number in moved:
        yield from (f"{word} {_name(model.body(number), 'body', number)} {part}" for part in parts)
