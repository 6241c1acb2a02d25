"""A process of its own for the trials of a worker, which can be ended when a trial hangs.

`TrialProcess` starts `python -m actr3d.experiment.trial_process`. Both sides write lines of JSON: the specification of an
experiment, then the numbers of its trials, then perhaps another specification; each is answered by one line.
"""

from __future__ import annotations

import gc
import json
import os
import re
import selectors
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
from contextlib import suppress
from pathlib import Path
from queue import SimpleQueue
from typing import Any, BinaryIO

from actr3d.actr.loading.helper_modules import HelperTexts
from actr3d.errors import ExperimentError
from actr3d.experiment.specification import Experiment, Specification
from actr3d.experiment.trial import Row, failed_row, run_trial
from actr3d.runner.before_exit import how_it_ended
from actr3d.runner.traceback_report import traceback_report

START = 600.0
"""The maximum time that a process may take to load an experiment [s]."""
LOOK = 1.0
"""The interval at which the process is checked [s]."""
ATTEMPTS = 3
"""The number of attempts at a trial whose process ends without an answer; another program may have ended it."""

FOLDER = "actr3d-trials-"
"""The beginning of the name of a folder for temporary files."""

LEFT: set[str] = set()
"""The clients that have left the cluster; no more of their trials are started."""

ADDRESS = re.compile(r" at 0x[0-9a-fA-F]+")
"""The address of an object in memory, as Python writes it in the text of the object: it is another one in each process."""

TIME_LIMIT = "time limit"
"""What the column `end` says of a trial that was ended at its limit."""


class TrialProcess:
    """Runs trials in a process of its own."""

    def __init__(self) -> None:
        self._busy = threading.Lock()
        self._closed = False
        self._process: subprocess.Popen[bytes] | None = None
        self._folder = ""
        """The folder for the temporary files of the process."""
        self._loaded: str | None = None
        self.columns: Row = {}
        """The columns of the last trial that are known before it runs, as this process had them; none if it did not answer."""
        self.seconds = 0.0
        """The duration of the last trial, without the start of the process [s]."""
        self.client = ""
        """The client of the cluster whose trials it runs."""
        self.about: dict[str, dict[str, str | None]] = {}
        """Units and meanings of columns of the loaded experiment, as far as they are known."""

    def run(self, specification: str, number: int, limit: float) -> Row:
        """Runs a trial and returns its row, as `run_trial` does; that of a trial that takes too long or ends its process has no measures.

        Args:
            specification: The experiment, as JSON.
            number: The number of the trial.
            limit: Its maximum wall time [s].

        Raises:
            ExperimentError: If the experiment cannot be loaded, `close` is called meanwhile, or its client has left.
        """
        loaded, ending, self.columns = False, "", {}
        with self._busy:
            for _ in range(ATTEMPTS):
                if self.client in LEFT:
                    raise ExperimentError("the experiment was stopped")
                loaded = self._load(specification)
                begin = time.perf_counter()
                try:
                    answer = self._ask(json.dumps(number), limit) if loaded else None
                except TimeoutError:
                    self.seconds = time.perf_counter() - begin
                    self._end()
                    return {"end": TIME_LIMIT, "error": f"the trial took longer than its limit of {limit:g} s, and was ended"}
                self.seconds = time.perf_counter() - begin
                if answer is not None:
                    self.about |= answer["about"]
                    self.columns = answer["columns"]
                    return answer["row"]
                ending = self._ending()
        if not loaded:
            raise ExperimentError(f"the process that loads the experiment {ending}")
        return {"end": "crash", "error": f"the process of the trial {ending}"}

    def end(self) -> None:
        """Ends the process; may be called from any thread. A load or a trial that this interrupts is tried again in a new process."""
        process = self._process
        if process is not None:
            with suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
        if self._busy.acquire(blocking=False):
            try:
                self._end()
            finally:
                self._busy.release()

    def close(self) -> None:
        """Ends the process for good; may be called from any thread. A trial that this interrupts has no row."""
        self._closed = True
        self.end()
        with self._busy:
            self._end()

    def _check_open(self) -> None:
        """Ends the process if `close` has been called.

        Raises:
            ExperimentError: If it has.
        """
        if self._closed:
            self._end()
            raise ExperimentError("the experiment was stopped")

    def _end(self) -> None:
        """Ends the process, and those that it has started."""
        process, self._process, self._loaded = self._process, None, None
        if process is not None:
            with suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
            process.wait()
            shutil.rmtree(self._folder, ignore_errors=True)
            for pipe in (process.stdin, process.stdout):
                if pipe is not None:
                    with suppress(OSError):
                        pipe.close()

    def _load(self, specification: str) -> bool:
        """Starts the process if there is none, and loads an experiment there if it is not the loaded one; returns whether the process
        has not ended meanwhile."""
        self._check_open()
        if self._process is None:
            # The order of sets of texts is the same in every process.
            self._folder = tempfile.mkdtemp(prefix=FOLDER)
            environment = {**os.environ, "PYTHONHASHSEED": "0", "TMPDIR": self._folder}
            command = [sys.executable, "-m", "actr3d.experiment.trial_process", self._folder]
            self._process = subprocess.Popen(
                command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=environment, start_new_session=True, bufsize=0
            )
            self._check_open()
        elif specification == self._loaded:
            return True
        self._loaded, self.about = None, {}
        try:
            answer = self._ask(json.dumps(specification), START)
        except TimeoutError:
            self._end()
            raise ExperimentError(f"the experiment did not load within {START:g} s") from None
        if answer is None:
            return False
        if "failed" in answer:
            self._end()
            raise ExperimentError(answer["failed"])
        self._loaded = specification
        return True

    def _ask(self, line: str, limit: float) -> Any:
        """Sends a line and returns the answer; None if the process has ended.

        Raises:
            TimeoutError: If there is no answer in time.
        """
        assert self._process is not None
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        with suppress(BrokenPipeError):
            self._process.stdin.write(line.encode() + b"\n")
        parts, deadline = [b""], time.monotonic() + limit
        with selectors.DefaultSelector() as waiting:
            waiting.register(self._process.stdout, selectors.EVENT_READ)
            while not parts[-1].endswith(b"\n"):
                ended = self._process.poll() is not None  # a child of the model may keep the pipe open
                if not waiting.select(min(LOOK, max(0.0, deadline - time.monotonic()))):
                    if ended:
                        return None
                    if time.monotonic() >= deadline:
                        raise TimeoutError
                    continue
                parts.append(os.read(self._process.stdout.fileno(), 1 << 16))
                if not parts[-1]:
                    return None
        return json.loads(b"".join(parts))

    def _ending(self) -> str:
        """Returns how the process ended, and releases it."""
        assert self._process is not None
        try:
            status = self._process.wait(5)
        except subprocess.TimeoutExpired:  # it goes on
            self._end()
            return "closed its output"
        self._end()
        return how_it_ended(status)


def main(folder: str) -> None:
    """Answers lines until the input ends.

    Args:
        folder: The folder for temporary files, which is deleted then.
    """
    # What a model prints, also through file descriptors, must not mix with the answers.
    answers = os.fdopen(os.dup(1), "wb", buffering=0)
    questions = os.fdopen(os.dup(0), "rb")
    nothing = os.open(os.devnull, os.O_RDWR)
    for number in (0, 1, 2):
        os.dup2(nothing, number)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the client ends this process
    asked: SimpleQueue[str | int] = SimpleQueue()
    reader = threading.Thread(target=_read, args=(questions, asked, folder), daemon=True)
    reader.start()
    with suppress(BrokenPipeError):
        _answer(asked, answers, folder)
    reader.join()  # it ends this process


def _answer(asked: SimpleQueue[str | int], answers: BinaryIO, folder: str) -> None:
    """Answers with what `run_trial` returns, or with the error of an experiment that cannot be loaded.

    The error of a trial is the same in every process: without addresses in memory, and with TMPDIR for the folder of temporary files.
    """
    question = asked.get()
    while True:
        try:
            assert isinstance(question, str), "the first question is an experiment"
            specification = Specification.from_json(question, "experiment")
            with specification.sealed() as helpers:
                experiment = Experiment(specification, helpers)
                answers.write(b"{}\n")
                described = 0
                own = os.getpid()
                while isinstance(question := asked.get(), int):
                    columns, row = _row_of(experiment, question, helpers)
                    if os.getpid() != own:  # the model has forked, and this is its child
                        os._exit(0)
                    if row["error"] is not None:
                        row["error"] = ADDRESS.sub("", row["error"]).replace(folder, "TMPDIR")
                    news = experiment.about if len(experiment.about) > described else {}
                    described = len(experiment.about)
                    answers.write(json.dumps({"columns": columns, "row": row, "about": news}, allow_nan=False).encode() + b"\n")
                    if not gc.get_freeze_count():
                        # All is loaded now, and stays: to look through it for garbage again and again takes time.
                        gc.collect()
                        gc.freeze()
                gc.unfreeze()
        except BrokenPipeError:
            raise
        except Exception as error:  # noqa: BLE001 - the client reports it, and ends this process
            answers.write(json.dumps({"failed": traceback_report(error).text.strip()}).encode() + b"\n")
            question = asked.get()


def _row_of(experiment: Experiment, number: int, helpers: HelperTexts) -> tuple[Row, Row]:
    """Returns the columns of a trial that are known before it runs, and what `run_trial` does; also for a trial that cannot even begin,
    because `derive` fails for its values."""
    columns: Row = {}
    try:
        columns = experiment.design.underived_trial(number).columns
        experiment.load_again(helpers)
        trial = experiment.design.trial(number)
        return trial.columns, run_trial(experiment, trial, helpers)
    except Exception as error:  # noqa: BLE001 - every error of a trial belongs in its row
        return columns, {**failed_row(error), "end": "error"}


def _read(questions: BinaryIO, asked: SimpleQueue[str | int], folder: str) -> None:
    """Reads experiments and numbers of trials, and ends this process at once when the client is gone."""
    for line in questions:
        asked.put(json.loads(line))
    for _ in range(ATTEMPTS):  # what runs here may be making a file
        shutil.rmtree(folder, ignore_errors=True)
    os.killpg(0, signal.SIGKILL)  # this process, and those that its models have started


if __name__ == "__main__":
    given = Path(sys.argv[1] if len(sys.argv) > 1 else "")
    if not given.name.startswith(FOLDER) or not given.is_dir() or any(given.iterdir()):  # it will be deleted
        sys.exit(f"TrialProcess starts this program with a new folder for temporary files (got {sys.argv[1:]})")
    main(str(given))
