"""The command `actr3d`: runs models and experiments, replays recordings, writes reports, and measures how fast models run."""

from __future__ import annotations

import argparse
import inspect
import os
import sys
import warnings
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import asdict
from functools import partial, wraps
from pathlib import Path
from typing import Any, NoReturn, TextIO

from actr3d.actr.compat.log_files import finished
from actr3d.actr.kernel.run_limits import RunLimits
from actr3d.actr.loading.source_text import read_source
from actr3d.errors import DesignError, SettingError, alternatives
from actr3d.output import ModelOutput, StandardOutput, all_written, printing_to, report_unwritten, standard_output
from actr3d.parameter_schema import Parameter
from actr3d.recording.schema import versions
from actr3d.runner.before_exit import before_the_end
from actr3d.runner.build_check import check_build, has_build
from actr3d.runner.cli_options import options_help, read_options, read_settings
from actr3d.runner.run import run_model
from actr3d.runner.traceback_report import traceback_report
from actr3d.trace import LEVELS, Trace, TraceEvent
from actr3d.values import to_json


def event_line(event: TraceEvent) -> str:
    """Returns an event as a human-readable line."""
    return f"{event.time:10.3f}  {event.source:<20} {event.kind:<10} {event.data_text}"


def run_command(options: argparse.Namespace) -> int:
    """Runs a model file."""
    with standard_output(apart=options.json) as out:
        return _run(options, out)


def _run(options: argparse.Namespace, out: TextIO) -> int:
    """Runs a model file; its events, and with --json its printed lines, go to `out`."""
    level = options.trace or ("all" if options.json else "none")
    trace = Trace("all" if options.record else level, keep=False)
    limits = RunLimits(seed=options.seed, until=options.until, trace=trace if trace.level != "none" else None)
    printed: ModelOutput | None = None
    if options.json:
        printed = ModelOutput(lambda text: print(TraceEvent(limits.clock(), "model", "output", {"text": text}).to_json(), file=out))
    if level != "none":
        show = TraceEvent.to_json if options.json else event_line
        # Lines that the model prints are shown unchanged, or by `printed`; a result is shown at the end.
        trace.listen(lambda event: None if out.closed or event.kind in ("output", "result") else print(show(event), file=out), level)
    limits.last_resort = partial(_leave, out, printed)
    trouble: BaseException | None = None
    result: Any = None
    try:
        with (
            warnings.catch_warnings(),
            printing_to(printed or out),
            before_the_end(partial(_keep_output, out, printed, options.record, limits)),
        ):
            warnings.showwarning = _show_warning
            result = run_model(options.file, limits, settings=partial(_settings, options), record=options.record)
    except (SystemExit, KeyboardInterrupt):
        if unwritten := all_written(out, printed):
            return report_unwritten(unwritten)
        raise
    except BaseException as error:  # noqa: BLE001 - every error of a model is shown to its author
        trouble = error
    if result is not None and not out.closed:
        if printed is not None:
            printed.finish()
        with suppress(OSError):  # reported below
            print(to_json({"event": "result", **asdict(result)}) if options.json else result, file=out)
    unwritten = all_written(out, printed)
    if trouble is not None and trouble is not unwritten:
        _complain(trouble)
    if unwritten:
        return report_unwritten(unwritten)
    return 0 if trouble is None else 2 if isinstance(trouble, SettingError) else 1


def _keep_output(out: TextIO, printed: ModelOutput | None, record: str | None, limits: RunLimits, ends: bool) -> None:
    """Writes the output before the model ends its process, and says what is kept of the run."""
    if ends:
        all_written(out, printed)
        if record is not None and not limits.ended:
            print(f"the model has ended its own process; '{record}' holds the run until then, without its end", file=sys.stderr, flush=True)
    else:
        with suppress(OSError, ValueError):
            out.flush()


def _settings(options: argparse.Namespace, fields: Sequence[Parameter]) -> dict[str, Any]:
    """Returns the parameter values given on the command line."""
    return {**read_settings(options.set, fields), **read_options(options.words, fields, options.general)}


def _help(run: argparse.ArgumentParser, file: str | None) -> int:
    """Prints the help: the general options, and those of a model file if one is named."""
    run.print_help()
    if file is None:
        return 0
    try:
        source = read_source(Path(file))
        check_build(source, file)
        if has_build(source):
            from actr3d.runner.model_factory import Blueprint

            with RunLimits(), printing_to(sys.stderr):
                fields = Blueprint(source, file, Path(file).parent).fields
            print(f"\noptions of {file}, after its name:\n{options_help(fields) or '  none'}")
    except Exception as error:  # noqa: BLE001 - every error of a model is shown to its author
        return _complain(error)
    return 0


def _leave(out: TextIO, printed: ModelOutput | None) -> NoReturn:
    """Ends the whole command as if the model had ended.

    For a model that keeps asking for time after its end and catches every exception: no error reaches the command
    from there.
    """
    with suppress(Exception):
        finished()
        sys.stdout.flush()
    unwritten = all_written(out, printed)
    code = 0 if unwritten is None else report_unwritten(unwritten)
    with suppress(Exception):
        sys.stderr.flush()
    os._exit(code)


def replay_command(options: argparse.Namespace) -> int:
    """Replays a recording and compares every byte: returns 0 if all are equal, 1 if not, 2 if that cannot be determined."""
    from actr3d.runner.replay_process import UNKNOWN, replay_in_process

    verdict = replay_in_process(options.file, trust=options.trust, any_version=options.any_version)
    out = sys.stderr if verdict.code == UNKNOWN else sys.stdout
    encoding = out.encoding or "utf-8"  # a stream in memory has no encoding
    out.write(verdict.text.encode(encoding, "backslashreplace").decode(encoding))
    return verdict.code


def _complain(error: BaseException) -> int:
    """Prints an error and its causes, with the modeller's own lines only."""
    print(traceback_report(error).text, end="", file=sys.stderr)
    return 1


def _show_warning(
    message: Warning | str,
    category: type[Warning],  # noqa: ARG001 - an argument of `warnings.showwarning`
    filename: str,
    lineno: int,
    file: TextIO | None = None,
    line: str | None = None,  # noqa: ARG001 - an argument of `warnings.showwarning`
) -> None:
    print(f"{filename}:{lineno}: warning: {message}", file=file or sys.stderr)


def _seconds(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = 0
    if not 0 < value < 1e9:
        raise argparse.ArgumentTypeError(f"must be a number of seconds > 0 and < 1e9 (got {text})")
    return value


def _seed(text: str) -> int:
    try:
        value = int(text)
    except ValueError:
        value = -1
    if value < 0:
        raise argparse.ArgumentTypeError(f"must be a whole number >= 0 (got {text})")
    return value


MOST_WORKERS = 1000
"""The maximum number of workers on one computer; each is a thread here and a process of its own."""
MOST = 1_000_000_000
"""The maximum of other numbers of things."""


def _count(text: str, most: int = MOST) -> int:
    if not text.isdecimal() or len(text) > len(str(most)) or not 1 <= int(text) <= most:
        given = text if len(text) <= 20 else f"{text[:10]}..."
        raise argparse.ArgumentTypeError(f"must be a whole number from 1 to {most} (got {given})")
    return int(text)


def _name(what: str, text: str) -> str:
    if not text:  # the value of a variable of the shell that is not set
        raise argparse.ArgumentTypeError(f"must be the name of a {what} (got '')")
    return text


_file, _folder, _measure, _scheduler = (partial(_name, what) for what in ("file", "folder", "measure", "scheduler"))


def _workers(text: str) -> int:
    return _count(text, MOST_WORKERS)


class _Version(argparse.Action):
    """Prints the version, and ends the command."""

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> NoReturn:
        print(f"actr3d {versions()['actr3d']}")
        parser.exit()


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="actr3d", description="Runs cognitive models in bodies, in exact lockstep.")
    parser.add_argument("--version", action=_Version, nargs=0, help="show the version of this program")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for add in (_add_run, _add_replay, _add_bench, _add_experiment, _add_fit, _add_report):
        add(commands)
    return parser


def _add_run(commands: Any) -> None:
    run = commands.add_parser(
        "run",
        help="run a model file",
        description="Runs a Python ACT-R model file, unchanged, or what a model file builds. "
        "`run FILE --help` also lists the options of the file.",
        epilog="Exit codes: 0 the model ran, whatever its result; 1 it failed, or the output could not be written; 2 wrong options; "
        "130 it was interrupted.",
        add_help=False,
        allow_abbrev=False,
    )
    run.add_argument("file", type=_file, metavar="FILE", nargs="?", help="the model file")
    general = [
        run.add_argument("-h", "--help", action="store_true", help="show this, and the options of the model file"),
        run.add_argument("--seed", type=_seed, metavar="N", help="seed of all random choices (default: a new one)"),
        run.add_argument("--until", type=_seconds, metavar="SECONDS", help="end at this simulated time at the latest"),
        run.add_argument("--trace", choices=LEVELS, help="which events to print (none; with --json all)"),
        run.add_argument("--json", action="store_true", help="print events as JSON, one a line; what the model prints becomes events too"),
        run.add_argument("--record", type=_file, metavar="RECORDING", help="record everything to this new file"),
        run.add_argument("--set", action="append", default=[], metavar="NAME=VALUE", help="set a parameter of what the file builds"),
    ]
    run.set_defaults(function=run_command, parser=run, general=[name for option in general for name in option.option_strings])


def _add_replay(commands: Any) -> None:
    again = commands.add_parser(
        "replay",
        help="run a recording again",
        description="Runs a recording again, and checks whether every byte agrees. It runs the code that the recording holds, "
        "with modules that are recorded or installed.",
        epilog="Exit codes: 0 every byte agrees, as far as the recording goes; 1 it differs; 2 it cannot be compared: it is damaged, "
        "of another format, made with other versions, or made elsewhere and not trusted, or the recorded program ended the process that "
        "ran it, or the output could not be written; 130 it was interrupted.",
    )
    again.add_argument("file", type=_file, metavar="RECORDING", help="the recording")
    again.add_argument("--trust", action="store_true", help="run it even though this installation did not make it")
    again.add_argument("--any-version", action="store_true", help="try even though it was made with other versions")
    again.set_defaults(function=replay_command)


def _add_bench(commands: Any) -> None:
    bench = commands.add_parser(
        "bench",
        help="measure speed",
        description="Measures speed, mostly as ratios of two costs in one run. Without a name, lists all benchmarks.",
        epilog="Exit codes: 0 all limits are met; 1 one is missed, or the benchmark failed; 2 wrong options, a package is missing, or the "
        "output could not be written; 130 it was interrupted.",
    )
    bench.add_argument("name", metavar="NAME", nargs="?", help="what to measure")
    bench.add_argument("--json", action="store_true", help="print one JSON object")
    bench.set_defaults(function=_bench)


def _add_experiment(commands: Any) -> None:
    experiment = commands.add_parser(
        "experiment",
        help="run an experiment with a model",
        description="Runs all trials of a design on all processors or a Dask cluster, and stores a row for each; without a name, lists the "
        "library's designs. Killed at any moment and continued with --resume, it loses no finished trial.",
        epilog="Exit codes: 0 all trials ran; 1 some failed, or the experiment cannot go on; 2 wrong options, an invalid design, or the "
        "output could not be written; 130 it was stopped.",
    )
    experiment.add_argument("name", metavar="NAME|FILE|FOLDER", nargs="?", help="a design, a file with one, or the folder of an experiment")
    _add_design_options(experiment)
    experiment.add_argument(
        "--out", type=_folder, metavar="FOLDER", help="the new folder for the results (default: the name of the design)"
    )
    experiment.add_argument("--resume", action="store_true", help="continue the experiment that is in the folder")
    experiment.add_argument("--any-version", action="store_true", help="continue although packages have other versions now")
    experiment.add_argument("--check", action="store_true", help="check the design, run two trials, and print what would run")
    experiment.add_argument("--json", action="store_true", help="print one JSON object a line: progress, and what is found")
    experiment.add_argument("--trial", type=int, metavar="ID", help="run this trial of the experiment in FOLDER again")
    experiment.add_argument("--record", type=_file, metavar="RECORDING", help="with --trial: record it to this new file")
    experiment.set_defaults(function=_experiment)


def _add_design_options(parser: argparse.ArgumentParser) -> None:
    """Adds the options that change a design, and those that say where its trials run."""
    parser.add_argument("--set", action="append", default=[], metavar="NAME=VALUE", help="replace levels of a factor, or a value")
    parser.add_argument("--participants", type=_count, metavar="N", help="number of participants of each group")
    parser.add_argument("--trials", type=_count, metavar="N", help="number of trials of each combination of levels")
    where = parser.add_mutually_exclusive_group()
    where.add_argument("--workers", type=_workers, metavar="N", help="number of workers here (default: one on each processor)")
    where.add_argument(
        "--scheduler", type=_scheduler, metavar="ADDRESS", help="run on the Dask cluster with this scheduler address or scheduler file"
    )


def _add_fit(commands: Any) -> None:
    fit = commands.add_parser(
        "fit",
        help="fit parameters of a model to data",
        description="Fits parameters of a model to means of human data, with intervals. The candidates stay in the folder: a fit that was "
        "stopped continues there.",
        epilog="Exit codes: 0 the parameters are fitted; 1 they cannot be fitted, or the output could not be written; 2 wrong options, an "
        "invalid design, or a package is missing; 130 it was stopped.",
    )
    fit.add_argument("name", metavar="NAME|FILE", help="a design, or a file with one")
    fit.add_argument("--parameter", action="append", default=[], metavar="NAME=LOW..HIGH", help="a parameter, and the range to search")
    fit.add_argument("--target", type=_file, metavar="NAME|FILE", help="human data (default: those that the design names)")
    fit.add_argument("--measure", type=_measure, metavar="NAME", help="the measure to fit, if the data have several")
    fit.add_argument("--candidates", type=_count, default=40, metavar="N", help="number of candidates (default 40)")
    fit.add_argument(
        "--hold-out",
        action="append",
        default=[],
        metavar="DESIGN[=FILE]",
        help="compare the fitted model, in another design, with the data of that design or of FILE, which are not fitted; "
        "of the options, only --set applies to that design",
    )
    fit.add_argument(
        "--ablate",
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help="show how well the model fits with this value changed (an ablation)",
    )
    fit.add_argument(
        "--recover",
        type=_count,
        default=0,
        metavar="N",
        help="simulate N data sets with known parameters, and estimate these (parameter recovery)",
    )
    _add_design_options(fit)
    fit.add_argument("--out", type=_folder, metavar="FOLDER", help="the folder for the candidates and the result")
    fit.add_argument("--json", action="store_true", help="print one JSON object a line")
    fit.set_defaults(function=_fit)


def _add_report(commands: Any) -> None:
    report = commands.add_parser(
        "report",
        help="write the report of an experiment",
        description="Writes a page with figures, tables and statistics of an experiment: report/index.html in its folder, which needs no "
        "network, with each figure as PNG and SVG and each table as CSV beside it.",
        epilog="Exit codes: 0 the report is written; 1 it is missing or incomplete, the data are not valid, or the output could not be "
        "written; 2 wrong options, or a package is missing; 130 it was interrupted.",
    )
    report.add_argument("folder", type=_folder, metavar="FOLDER", help="the folder of an experiment")
    report.add_argument(
        "--human", type=_file, metavar="FILE", help="show these human data beside the model (default: those that the design names)"
    )
    report.add_argument("--compare", type=_folder, metavar="FOLDER", help="show another experiment beside this one")
    report.add_argument(
        "--out", type=_folder, metavar="FOLDER", help="the folder for the report (default: report in that of the experiment)"
    )
    report.set_defaults(function=_report)


def _with_packages(work: Callable[[argparse.Namespace], int]) -> Callable[[argparse.Namespace], int]:
    """Marks a command that may need packages for experiments, which may not be installed, and whose errors are shown to a modeller."""

    @wraps(work)
    def command(options: argparse.Namespace) -> int:
        try:
            return work(options)
        except ModuleNotFoundError as error:
            if error.name is None or error.name.startswith("actr3d"):
                return _complain(error)
            text = f"needs the package '{error.name}'; install: pip install 'actr3d[experiment]'"
            print(f"actr3d {options.command}: {text}", file=sys.stderr)
            return 2
        except (SettingError, DesignError) as error:
            print(f"error: {error}", file=sys.stderr)
            return 2
        except Exception as error:
            if isinstance(sys.stdout, StandardOutput) and error is sys.stdout.trouble:
                raise
            return _complain(error)

    return command


@_with_packages
def _bench(options: argparse.Namespace) -> int:
    from actr3d.bench import find_benchmarks  # benchmarks are slow to import
    from actr3d.benchmark import report

    known = find_benchmarks()
    if options.name is None:
        listed = {name: (inspect.getdoc(function) or name).splitlines()[0] for name, function in sorted(known.items())}
        width = max(map(len, listed)) + 2
        print(to_json(listed) if options.json else "\n".join(f"{name:<{width}}{about}" for name, about in listed.items()))
        return 0
    if options.name not in known:
        raise SettingError(f"no benchmark '{options.name}'{alternatives(options.name, sorted(known))}")
    return report(known[options.name](), json_output=options.json)


@_with_packages
def _experiment(options: argparse.Namespace) -> int:
    from actr3d.experiment import command

    out = command.Output(json=options.json)
    if options.name is None:
        _refuse(options, (*BESIDE_TRIAL, "trial", "record"), "name a design, a file or the folder of an experiment, or")
        return command.list_designs(out)
    if options.trial is not None or options.record is not None:
        if options.trial is None or options.record is None:
            raise SettingError("--trial ID and --record RECORDING are given together")
        _refuse(options, BESIDE_TRIAL, "--trial: runs a trial again exactly as it was;")
        return command.run_again(options.name, options.trial, options.record, out)
    numbers = _numbers(options)
    if options.check:
        _refuse(options, BESIDE_CHECK, "--check: runs two trials on this computer and stores nothing;")
        return command.check(options.name, out, **numbers)
    if options.any_version and not options.resume:
        raise SettingError("--any-version: is for an experiment that is continued; add --resume")
    how = {name: getattr(options, name) for name in ("workers", "scheduler", "resume", "any_version")}
    if command.is_folder(options.name) and not any((*numbers.values(), *how.values(), options.out)):
        return command.show_state(options.name, out)
    return command.run(options.name, out, folder=options.out, **numbers, **how)


@_with_packages
def _fit(options: argparse.Namespace) -> int:
    from actr3d.experiment import command

    same = ("target", "measure", "candidates", "hold_out", "ablate", "recover", "workers", "scheduler")
    given = {name: getattr(options, name) for name in same}
    out = command.Output(json=options.json)
    return command.fit(options.name, out, ranges=options.parameter, folder=options.out, **_numbers(options), **given)


@_with_packages
def _report(options: argparse.Namespace) -> int:
    from actr3d.experiment.report import command

    print(command.write_report(options.folder, human=options.human, compare=options.compare, out=options.out))
    return 0


UNWRITTEN = {"replay": 2, "bench": 2, "experiment": 2}
"""The exit codes if the output cannot be written, of the commands whose exit code 1 is a finding."""
BESIDE_CHECK = ("workers", "scheduler", "out", "resume", "any_version")
"""The options of `actr3d experiment` that mean nothing for a check."""
BESIDE_TRIAL = (*BESIDE_CHECK, "set", "participants", "trials", "check")
"""The options of `actr3d experiment` that mean nothing for one trial."""


def _refuse(options: argparse.Namespace, names: Sequence[str], why: str) -> None:
    """Checks that none of some options is given.

    Args:
        options: The options.
        names: The names of those that must not be given.
        why: The beginning of the error, which ends with what to leave out.

    Raises:
        SettingError: If one is.
    """
    idle = [f"--{name.replace('_', '-')}" for name in names if (given := getattr(options, name)) is not False and given not in (None, [])]
    if idle:
        raise SettingError(f"{why} leave out {' and '.join(idle)}")


def _numbers(options: argparse.Namespace) -> dict[str, Any]:
    """Returns the options that change a design."""
    return {"values": read_settings(options.set, (), levels=True), "participants": options.participants, "trials": options.trials}


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs the command; returns its exit code."""
    given = list(sys.argv[1:] if arguments is None else arguments)
    with standard_output(apart=False) as out, printing_to(out):
        code: Any = 0
        try:
            code = _command(given)
        except (OSError, SystemExit) as error:
            unwritten = all_written(out, None)
            if unwritten is None or (isinstance(error, OSError) and error is not unwritten):
                raise
            if isinstance(error, SystemExit):
                code = error.code
        else:
            unwritten = all_written(out, None)
            if unwritten is None:
                return code
        report_unwritten(unwritten)
        return code if code not in (0, 1) else UNWRITTEN.get(given[0], 1)


def _command(arguments: list[str]) -> int:
    parser = _parser()
    options, words = parser.parse_known_args(arguments)
    if options.command == "run":
        if options.help:
            return _help(options.parser, options.file)
        _check_run(options, words, arguments)
    elif words:
        parser.error(f"unrecognized arguments: {' '.join(words)}")
    if isinstance(sys.stdout, StandardOutput) and getattr(options, "record", None):
        sys.stdout.raises = False  # a recorded run goes on without its output: its recording is whole
    try:
        return options.function(options)
    except KeyboardInterrupt:
        print("stopped", file=sys.stderr)
        return 130


def _check_run(options: argparse.Namespace, words: list[str], arguments: list[str]) -> None:
    """Checks that a model file is named, and that the model's own arguments come after its name."""
    file: str | None = options.file
    if file is None:
        options.parser.error("the following arguments are required: FILE")
    elif (first := next((word for word in words if word.startswith("-")), None)) and arguments.index(first) < arguments.index(file):
        options.parser.error(f"{first} is not an option of every run; those of the model file come after its name")
    options.words = words
