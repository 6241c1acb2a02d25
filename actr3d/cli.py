"""The command `actr3d`: runs models, and measures how fast they run."""

from __future__ import annotations

import argparse
import importlib
import os
import sys
import warnings
from collections.abc import Sequence
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any, NoReturn, TextIO

from actr3d.actr import logger as logs
from actr3d.actr.limits import RunLimits
from actr3d.errors import Actr3dError
from actr3d.output import all_written, standard_output
from actr3d.printing import ModelOutput, printing_to
from actr3d.running.complaint import complaint
from actr3d.running.run import run_model, settings_of
from actr3d.trace import LEVELS, Trace, TraceEvent


def event_line(event: TraceEvent) -> str:
    """Returns an event as a line that a person reads."""
    words = " ".join(f"{key}={value}" for key, value in event.data.items())
    return f"{event.time:10.3f}  {event.source:<20} {event.kind:<10} {words}"


def run_command(options: argparse.Namespace) -> int:
    """Runs a model file."""
    with standard_output(apart=options.json) as out:
        return _run(options, out)


def _run(options: argparse.Namespace, out: TextIO) -> int:
    """Runs a model file; its events, and with --json its own lines, go to `out`."""
    level = options.trace or ("all" if options.json else "none")
    trace = Trace("all" if options.record else level, keep=False)
    limits = RunLimits(seed=options.seed, until=options.until, trace=trace if trace.level != "none" else None)
    printed: ModelOutput | None = None
    if options.json:
        printed = ModelOutput(lambda text: print(TraceEvent(limits.clock(), "model", "output", {"text": text}).to_json(), file=out))
    if level != "none":
        show = TraceEvent.to_json if options.json else event_line
        # Lines that the model prints are shown as they are, or by `printed`.
        trace.listen(lambda event: None if out.closed or event.kind == "output" else print(show(event), file=out), level)
    limits.last_resort = partial(_leave, out, printed)
    trouble: Exception | None = None
    try:
        with warnings.catch_warnings(), printing_to(printed or out):
            warnings.showwarning = _show_warning
            run_model(options.file, limits, settings=settings_of(options.set), record=options.record)
    except Exception as error:  # noqa: BLE001 - whatever a model raises is shown to its author
        trouble = error
    except (SystemExit, KeyboardInterrupt):
        if unwritten := all_written(out, printed):
            return _complain_of_output(unwritten)
        raise
    unwritten = all_written(out, printed)
    if trouble is not None and not (unwritten and isinstance(trouble, OSError)):
        _complain(trouble)
    if unwritten:
        return _complain_of_output(unwritten)
    return 0 if trouble is None else 1


def _leave(out: TextIO, printed: ModelOutput | None) -> NoReturn:
    """Ends the whole command as if the model had come to its end.

    For a model that goes on asking for time after its last moment and catches whatever it is told: no error reaches us
    from there.
    """
    with suppress(Exception):
        logs.finished()
        sys.stdout.flush()
    unwritten = all_written(out, printed)
    code = 0 if unwritten is None else _complain_of_output(unwritten)
    with suppress(Exception):
        sys.stderr.flush()
    os._exit(code)


def _complain_of_output(error: OSError) -> int:
    """Says why the output cannot be written, unless only nobody reads it any more."""
    if not isinstance(error, BrokenPipeError):
        print(f"error: cannot write the output: {error.strerror}", file=sys.stderr)
    return 1


def replay_command(options: argparse.Namespace) -> int:
    """Runs a recording again, and says whether every byte agrees: 0 where it does, 1 where not, 2 where it cannot tell."""
    from actr3d.recording import Recorded
    from actr3d.running.replay import replay

    try:
        with Recorded(options.file) as recorded:
            comparison = replay(recorded, any_version=options.any_version)
    except Actr3dError as error:
        _complain(error)
        return 2
    print(comparison)
    return 0 if comparison.difference is None else 1


def _complain(error: BaseException) -> int:
    """Prints an error, and what caused it, with the modeller's own lines only."""
    print(complaint(error).text, end="", file=sys.stderr)
    return 1


def _show_warning(
    message: Warning | str,
    category: type[Warning],  # noqa: ARG001 - what `warnings` gives
    filename: str,
    lineno: int,
    file: TextIO | None = None,
    line: str | None = None,  # noqa: ARG001 - what `warnings` gives
) -> None:
    print(f"{filename}:{lineno}: warning: {message}", file=file or sys.stderr)


def _seconds(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = 0
    if not 0 < value < 1e9:
        raise argparse.ArgumentTypeError(f"must be a number of seconds above 0 and below 1e9 (got {text})")
    return value


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="actr3d", description="Runs cognitive models in bodies, in exact lockstep.")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    run = commands.add_parser("run", help="run a model file", description="Runs a Python ACT-R model file, unchanged.")
    run.add_argument("file", metavar="FILE", help="the model file")
    run.add_argument("--seed", type=int, metavar="N", help="what all random choices come from (a fresh one unless given)")
    run.add_argument("--until", type=_seconds, metavar="SECONDS", help="end at this simulated time at the latest")
    run.add_argument("--trace", choices=LEVELS, help="which events to print (none; with --json all)")
    run.add_argument("--json", action="store_true", help="print events as JSON, one a line; what the model prints becomes events too")
    run.add_argument("--record", metavar="RECORDING", help="record everything to this new file")
    run.add_argument("--set", action="append", default=[], metavar="NAME=VALUE", help="set a parameter of what the file builds")
    run.set_defaults(function=run_command)
    again = commands.add_parser("replay", help="run a recording again", description="Runs a recording again: does every byte agree?")
    again.add_argument("file", metavar="RECORDING", help="the recording")
    again.add_argument("--any-version", action="store_true", help="try even though it was made with other versions")
    again.set_defaults(function=replay_command)
    bench = commands.add_parser("bench", help="measure speed", description="Measures speed, as ratios within one run.")
    bench.add_argument("name", choices=["core", "camera", "lockstep"], help="what to measure")
    bench.add_argument("--json", action="store_true", help="print one JSON object")
    bench.set_defaults(function=_bench)
    soak = commands.add_parser("soak", help="run a million ticks", description="Runs a million ticks: no drift, no growth in memory?")
    soak.add_argument("--json", action="store_true", help="print one JSON object")
    soak.set_defaults(function=_bench, name="soak")
    return parser


def _bench(options: argparse.Namespace) -> int:
    bench: Any = importlib.import_module(f"actr3d.bench.{options.name}")
    return bench.main(json_output=options.json)


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs the command; returns its exit code."""
    if arguments is None and sys.argv[1:2] in (["run"], ["replay"]):
        _order_sets()
    if sys.stdout is None:  # it was closed before we came
        sys.stdout = Path(os.devnull).open("w", encoding="utf-8")  # noqa: SIM115 - it stays until the end
    options: Any = _parser().parse_args(arguments)
    try:
        return options.function(options)
    except KeyboardInterrupt:
        print("stopped", file=sys.stderr)
        return 130


def _order_sets() -> None:
    """Starts the command again where the order of sets of texts would differ between two runs of one seed.

    Whatever PYTHONHASHSEED is, models run with 0. A Python that is told not to read the environment (`-E`, `-I`) cannot be
    told this either.
    """
    if sys.flags.hash_randomization and not sys.flags.ignore_environment:
        os.environ["PYTHONHASHSEED"] = "0"
        os.execv(sys.executable, [sys.executable, *sys.orig_argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
