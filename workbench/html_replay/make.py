"""Creates the HTML replay of a recording."""

from __future__ import annotations

import html
import re
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from actr3d.clock import MICROSECONDS, seconds
from actr3d.recording import Recorded
from actr3d.trace import TraceEvent, top_path
from actr3d.trace_kinds import GROUPS, KINDS
from actr3d.values import plain_to_json, shortened
from workbench.curves import stride
from workbench.files import ModelFolder
from workbench.geom_colours import dress
from workbench.html_replay.change_texts import ChangeTexts, chunk_text, value_text, widths_in
from workbench.html_replay.shapes import Shapes, packed, poses_of
from workbench.loader import listing_of
from workbench.program_time import timed_events
from workbench.recorded_simulations import RecordedSimulation, simulations_of
from workbench.run_facts import seed_of, source_of
from workbench.scene_colours import palette
from workbench.scene_framing import SceneFraming, grounds_of
from workbench.shipped import static
from workbench.time_text import time_text

RATE = 30
"""About this many frames per second of simulated time are stored; the page interpolates between them."""
MAX_FRAMES = 20_000
MAX_NUMBERS = 7_000_000
"""Maximum number of pose values, 4 bytes each; long runs, or those with many bodies, get fewer frames."""
MAX_EVENTS = 50_000
"""Maximum number of events; only the first are included."""
MAX_STAGED = 2_000
"""If the stage has more corners, those of its bounding box are used instead."""
LONGEST = 400
"""Maximum length of the text of an event or error [characters]."""


def write_replay(path: Path, to: Path, *, models: str | None = None) -> None:
    """Writes the replay of a recording to a file.

    Args:
        path: The recording.
        to: The new file.
        models: The models folder, below which the path of the model is shown; None for its name alone.

    Raises:
        RecordingError: If the recording cannot be read, or its scene is too large.
        OSError: If the file cannot be written.
    """
    with Recorded(path) as recorded:
        facts = _facts(recorded, models)
        simulations = simulations_of(recorded)
        events, agents = _events(recorded, _changes(recorded, simulations))
        found = [one for one in simulations if one.mj_model.ngeom > 0 and any(one.past.between(0, None))]
        scenes = [_scene(one, list(agents[one.number]), len(found)) for one in found]
        content = {**facts, "palette": palette(), "events": events, "scenes": scenes}
    # No text from a model can close the HTML element that contains it.
    data = plain_to_json(content).replace("<", "\\u003c").replace("\u2028", "\\u2028").replace("\u2029", "\\u2029")
    folder = Path(__file__).parent
    page, style = ((folder / name).read_text(encoding="utf-8") for name in ("page.html", "style.css"))
    parts = {"TITLE": html.escape(str(facts["title"])), "DATA": data, "STYLE": style, "SCRIPT": _scripts(folder)}
    pieces = page.split("@@")
    whole = "".join(parts[piece] if number % 2 else piece for number, piece in enumerate(pieces))
    to.write_text(whole, encoding="utf-8", errors="backslashreplace")  # a path may have bytes that are not UTF-8


def _scripts(folder: Path) -> str:
    """Returns the scripts of the file as one: its own, and modules of the page that import nothing."""
    own = [folder / f"{name}.js" for name in ("space", "solids", "shades", "camera", "drawing", "events", "player")]
    shared = [static() / "scene" / "space.js", static() / "parts" / "units.js"]
    texts = [path.read_text(encoding="utf-8") for path in (own[0], *shared, *own[1:])]
    return "\n".join(re.sub("^export ", "", text, flags=re.MULTILINE) for text in texts)


def _facts(recorded: Recorded, models: str | None) -> dict[str, Any]:
    facts = recorded.facts
    file = facts.get("file", "")
    model = Path(file).name if models is None else ModelFolder(Path(models)).shown(file)
    seed = seed_of(facts)
    ended, branched = facts.get("ended"), facts.get("branched")
    branch = "" if branched is None else f" · branch at {time_text(branched, 2)}"
    return {
        "title": f"{model or 'a run'} · seed {seed}{branch}",
        "model": model,
        "seed": str(seed),
        "parameters": _plain(facts.get("parameters", {})),
        "branched": branched,
        "ended": None if ended is None else str(ended.get("by")),
        "failed": None if facts.get("failed") is None else shortened(str(facts["failed"]), LONGEST),
    }


def _changes(recorded: Recorded, simulations: Iterable[RecordedSimulation]) -> ChangeTexts:
    facts = recorded.facts
    listing = listing_of(source_of(facts))
    walls = [(one.number, one.mj_model, one.facts["world"].get("walls", {})) for one in simulations]
    widths = {(number, name): width for number, model, gaps in walls for name, width in widths_in(model, gaps)}
    return ChangeTexts(listing, facts.get("parameters", {}), widths)


def _events(recorded: Recorded, changes: ChangeTexts) -> tuple[dict[str, Any], Mapping[int, Iterable[str]]]:
    """Returns the events as rows, the number of events left out, the time of the last event and the result separately; and the names of
    the agents of each run, by its number, in the order of their first events, which is the model's."""
    rows: list[tuple[float, str, str, str]] = []
    agents: defaultdict[int, dict[str, None]] = defaultdict(dict)
    result: dict[str, Any] | None = None
    end = 0.0
    for event in timed_events(recorded):
        if len(rows) < MAX_EVENTS:
            changes.take(event)
            rows.append((event.time, event.source, event.kind, _text(event, changes)))
        agents[event.run][_agent(event)] = None
        end = event.time
        if event.kind == "result":
            result = dict(event.data)
    kinds = {kind: _kind(kind) for _, _, kind, _ in rows}
    more = recorded.event_count - len(rows)
    return {"rows": rows, "kinds": kinds, "more": more, "end": end, "result": None if result is None else _plain(result)}, agents


def _kind(name: str) -> tuple[str, bool]:
    """Returns the title of a kind of event, and whether its group is shown at first."""
    kind = KINDS.get(name)
    return (name, GROUPS["other"].shown) if kind is None else (kind.title, GROUPS[kind.group].shown)


def _plain(values: Mapping[str, Any]) -> dict[str, str]:
    """Returns names and values as texts."""
    return {str(name): value_text(value) for name, value in values.items()}


def _text(event: TraceEvent, changes: ChangeTexts) -> str:
    """Returns the content of an event as one line."""
    data, kind = event.data, KINDS.get(event.kind)
    if kind is not None and kind.text:
        text = re.sub(r"\{(\w+)\}", lambda found: value_text(data.get(found[1])), kind.text)
    elif event.kind in ("buffer", "add"):
        text = chunk_text(data.get("chunk"))
    elif event.kind == "command":
        text = changes.text(event)
    else:
        text = "  ".join(f"{name}={value_text(value)}" for name, value in data.items())
    return shortened(text, LONGEST)


def _agent(event: TraceEvent) -> str:
    """Returns the name of an event's agent in its simulation."""
    prefix = "" if event.run == 1 else f"{top_path(event.run)}."
    return event.source.removeprefix(prefix).partition(".")[0]


def _scene(simulation: RecordedSimulation, agents: Sequence[str], scenes: int) -> dict[str, Any]:
    """Returns the shapes of a simulation and their poses in each stored frame.

    Args:
        simulation: The simulation.
        agents: The names of its agents; the view follows the first one.
        scenes: How many scenes there are, which share the frames.
    """
    model, period, past = simulation.mj_model, simulation.period, simulation.past
    bodies_by_name = simulation.facts["world"]["bodies"]
    roots = [bodies_by_name[name]["root"] for name in agents if name in bodies_by_name]
    dress(model, roots)
    shapes = Shapes(model)
    bodies = shapes.bodies
    ticks = past.furthest
    most = max(2, min(MAX_FRAMES, MAX_NUMBERS // (7 * max(1, len(bodies)))) // scenes)
    stored = past.every
    every = stored * max(1, round(MICROSECONDS / RATE / (period * stored)), stride(ticks // stored + 1, most - 1))
    frames = [(tick, state) for tick, state, _ in past.between(0, None) if tick % every == 0 or tick == ticks]
    times = [seconds(simulation.begin + tick * period) for tick, _ in frames]
    poses = poses_of(model, bodies, (state for _, state in frames))
    return {
        "shapes": shapes.parts,
        "meshes": shapes.meshes,
        "grounds": grounds_of(model),
        "times": packed(times, "<f4"),
        "poses": packed(poses, "<f4"),
        "stage": _stage(SceneFraming(model, roots), bodies),
    }


def _stage(stage: SceneFraming, bodies: list[int]) -> dict[str, Any]:
    """Returns the part of the scene that is shown first, and the shape that the view follows: the body, or the next one after it."""
    follow = next((number for number, body in enumerate(bodies) if body >= stage.body), 0)
    return {
        "corners": stage.corners_within(MAX_STAGED).round(3).tolist(),
        "low": stage.low.tolist(),
        "high": stage.high.tolist(),
        "ahead": stage.ahead.tolist(),
        "follow": follow,
    }
