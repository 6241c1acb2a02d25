"""Records the golden traces: what each model of `models` does with seed 1, event by event.

Usage: `uv run python tests/golden/make.py` writes them all anew, `uv run python tests/golden/make.py addition tutorial/counting` only
those named. The trace of `models/tutorial/counting.py` is `tests/golden/tutorial/counting.jsonl`, that of another variant of a model
`tests/golden/aperture_passage@replication.jsonl`. Look at the difference
(`git diff tests/golden`) before keeping it: every changed line is a changed behaviour.
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

GOLDEN = Path(__file__).resolve().parent
ROOT = GOLDEN.parent.parent
MODELS = ROOT / "models"
IN_FULL = {"tutorial/compilation", "tutorial/counting", "tutorial/imaginal", "tutorial/parallel_system", "tutorial/two_agents"}
"""The models whose golden traces hold every event; those of the others hold productions and buffers, or productions only."""
VARIANTS = {"aperture_passage": ("predictive", "replication")}
"""By model, the variants that have golden traces besides the default."""
PRODUCTIONS_ONLY = {"paired_associates"}
"""The models without bodies whose golden traces hold productions, and no buffers, because they are too long otherwise."""


def model_names() -> list[str]:
    """Returns the path of every model below `models`, without its ending, and once more with each other variant that it has."""
    names = [path.relative_to(MODELS).with_suffix("").as_posix() for path in MODELS.rglob("*.py")]
    return sorted([*names, *(f"{name}@{variant}" for name in names for variant in VARIANTS.get(name, ()))])


def model_file(name: str) -> str:
    """Returns the path of a model's file, from the project's folder."""
    return f"models/{name.partition('@')[0]}.py"


def is_embodied(name: str) -> bool:
    """Returns whether a model has bodies: what these sense is the same to the last digit only on one kind of processor, when they act
    everywhere."""
    return "\ndef build(" in (ROOT / model_file(name)).read_text(encoding="utf-8")


def golden_names() -> list[str]:
    """Returns the path of every golden trace, without its ending."""
    return sorted(path.relative_to(GOLDEN).with_suffix("").as_posix() for path in GOLDEN.rglob("*.jsonl"))


def options(name: str, seed: int = 1) -> tuple[str, ...]:
    """Returns how a model's golden trace is made."""
    level = "all" if name in IN_FULL else "production" if name in PRODUCTIONS_ONLY or is_embodied(name) else "buffer"
    variant = name.partition("@")[2]
    return (*(("--variant", variant) if variant else ()), "--seed", str(seed), "--trace", level, "--json")


def golden_file(name: str) -> Path:
    """Returns where a model's golden trace is kept."""
    return GOLDEN / f"{name}.jsonl"


def command(name: str, *words: str) -> list[str]:
    """Returns the arguments of `actr3d` that run a model, from the project's folder."""
    return ["run", model_file(name), *(words or options(name))]


def record(name: str, *words: str) -> bytes:
    """Runs a model in a process of its own, and returns what that printed.

    Raises:
        RuntimeError: If it fails, or complains of anything.
    """
    environment = {**os.environ, "PYTHONHASHSEED": "0", "PYTHONIOENCODING": "utf-8"}
    arguments = [sys.executable, "-m", "actr3d", *command(name, *words)]
    done = subprocess.run(arguments, capture_output=True, cwd=ROOT, env=environment, timeout=60, check=False)
    if done.returncode != 0 or done.stderr:
        raise RuntimeError(f"{name} ended with {done.returncode}:\n{done.stderr.decode()}")
    return done.stdout


def main() -> None:
    """Records the models named on the command line, or all; drops traces that no model has any more."""
    chosen = sys.argv[1:] or model_names()
    for name in chosen:
        file = golden_file(name)
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(record(name))
    if not sys.argv[1:]:
        for name in set(golden_names()) - set(chosen):
            golden_file(name).unlink()


if __name__ == "__main__":
    main()
