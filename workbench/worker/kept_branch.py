"""Keeps what lies ahead of a run before a user changes something in its past."""

from __future__ import annotations

from pathlib import Path

from actr3d.clock import seconds
from actr3d.errors import RecordingError
from actr3d.recording import Recording
from workbench.retention import new_branch, superfluous_branches
from workbench.time_text import time_text
from workbench.worker.controlled_run import LossError
from workbench.worker.messages import Branched
from workbench.worker.run_controller import RunController


class KeptBranch:
    """What lies ahead of a run that is about to be changed, kept as a recording of its own.

    Args:
        controller: Controls the run.
        recording: The recording of the run; None if it is not recorded.
        clock: The present time [us].
        furthest: The time that the run has reached [us].
        drop: Whether what lies ahead may be lost if it cannot be kept.

    Raises:
        LossError: If it cannot be kept, and may not be lost; or if the recording can no longer be written.
    """

    def __init__(self, controller: RunController, recording: Recording | None, clock: int, furthest: int, *, drop: bool) -> None:
        self._controller = controller
        self._start = start = controller.channel.start
        self._at, self._until = seconds(clock), seconds(furthest)
        self._ahead = furthest > clock
        self._drop = drop
        self._branch: Path | None = None
        self._ancestors = controller.run.ancestors
        self._left_later = bool(self._ancestors) and self._ancestors[0][1] > self._at
        """Whether the run branched from its origin recording at a time after the present moment."""
        # A run that repeats a recording is kept by that recording.
        self._repeated = Path(start.recorded) if start.recorded is not None and controller.repeats_recording else None
        self._is_gone = self._repeated is not None and not self._repeated.is_file()
        lost = self._copy(recording) if self._ahead and (self._repeated is None or self._is_gone) else ""
        failure = controller.run.recording_failure() if self._ahead else None
        if not drop and (lost or failure is not None):
            ahead = f"what lies ahead, from {time_text(self._at)} to {time_text(self._until)}, would be lost"
            later = "what follows would not be recorded"
            text = later if not lost else ahead if failure is None else f"{ahead}, and {later}"
            raise LossError(f"{text}: {lost if failure is None else failure.reason}")

    def _copy(self, recording: Recording | None) -> str:
        """Keeps what lies ahead; returns why it cannot be kept, or nothing."""
        if self._is_gone:
            return "the recording that this run repeats has been deleted or renamed"
        if recording is None or self._start.record is None:
            return "the run is not recorded"
        path, origin = new_branch(Path(self._start.record), self._at), Path(self._start.record).stem
        try:
            # The copy is of the run as it was. If the run branched from another recording after the present moment, the copy has that
            # branch point, and keeps the run's own facts.
            tie = {} if self._left_later else {"branched": self._at, "origin": origin, "ancestors": self._ancestors}
            recording.copy_to(path, named=path.stem, **tie)
        except RecordingError as error:
            return f"it cannot be kept ({error.reason or error})"
        self._branch = path
        return ""

    def undo(self) -> None:
        """Removes the copy, because nothing was changed."""
        if self._branch is not None:
            self._branch.unlink(missing_ok=True)

    def announce_undone(self) -> None:
        """Informs the server that the run is now where a user has undone a change, and pauses there."""
        controller = self._controller
        controller.status = "paused"
        self.announce(len(controller.run.trace), "undone")
        controller.went_back(controller.reason)

    def announce(self, events: int, what: str = "changed") -> None:
        """Informs the server of what was done, and that the run continues differently after this number of events."""
        is_unrecorded = self._ahead and self._drop and self._controller.give_up_recording()
        if self._repeated is not None:
            self._controller.leave_recording(self._at, self._until)
        elif self._branch is not None:
            for old in superfluous_branches(Path(self._start.record or "")):
                old.unlink(missing_ok=True)
            if self._left_later:
                self._controller.run.become_branch(self._branch.stem, self._at, self._ancestors)
            self._controller.run.flush()  # pages list recordings again when they hear of the branch
            self._controller.channel.post(Branched(recording=self._branch.stem, at=self._at, until=self._until))
        is_kept = self._branch is not None or (self._repeated is not None and not self._is_gone)  # pages say so in a notice
        done = [f"{what} at {time_text(self._at, 2)}"]
        if self._ahead and not is_kept:
            done.append("the rest was lost")
        if is_unrecorded:
            done.append("what follows is not recorded")
        self._controller.continue_differently(events, "; ".join(done), ahead=self._ahead)
