"""Keeps the helper modules of a run, and reports to the server which texts of which files it has loaded."""

from __future__ import annotations

from collections.abc import Generator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path

from actr3d.actr.loading.helper_modules import HelperTexts
from actr3d.actr.loading.sealed import sealed
from workbench.worker.channel import Channel
from workbench.worker.messages import Loaded, text_digest


class ReportedHelpers(HelperTexts):
    """Keeps the texts of helper modules, and reports each to the server.

    Args:
        channel: The connection to the server.
        known: The modules loaded in an earlier run, which are used even if the files have changed.
    """

    def __init__(self, channel: Channel, known: Mapping[str, Sequence[str]]) -> None:
        super().__init__(known)
        self._link = channel

    def keep(self, name: str, file: str, folder: Path | None, text: str) -> None:
        """Stores the text of a module that is about to run, and reports it."""
        super().keep(name, file, folder, text)
        self._link.post(Loaded(file=file, digest=text_digest(text)))


@contextmanager
def helpers_of(channel: Channel, known: Mapping[str, Sequence[str]]) -> Generator[HelperTexts]:
    """Yields the helper modules of a run: only those in its recording for a repeated run, otherwise those in its folder.

    Args:
        channel: The connection to the server.
        known: The modules loaded in an earlier run, which are used even if the files have changed.
    """
    start = channel.start
    if start.recorded is None:
        yield ReportedHelpers(channel, known)
    else:
        with sealed(start.path, start.source, known) as texts:
            yield texts
