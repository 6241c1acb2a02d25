"""The helper modules of a run: the server is told which texts of which files it has loaded."""

from __future__ import annotations

from collections.abc import Generator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path

from actr3d.actr.loading.helper_modules import HelperTexts
from actr3d.actr.loading.sealed import sealed
from workbench.worker.link import Link
from workbench.worker.messages import Loaded, digest_of


class ToldHelpers(HelperTexts):
    """Keeps the texts of helper modules, and tells the server of each.

    Args:
        link: The wire to the server.
        known: What was loaded in an earlier run, whatever the files hold now.
    """

    def __init__(self, link: Link, known: Mapping[str, Sequence[str]]) -> None:
        super().__init__(known)
        self._link = link

    def keep(self, name: str, file: str, folder: Path | None, text: str) -> None:
        """Takes the text of a module that is about to run."""
        super().keep(name, file, folder, text)
        self._link.post(Loaded(file=file, digest=digest_of(text)))


@contextmanager
def helpers_of(link: Link, known: Mapping[str, Sequence[str]]) -> Generator[HelperTexts]:
    """Yields the helper modules of a run: of one that is lived through again those in its recording alone, of others those in its folder.

    Args:
        link: The wire to the server.
        known: What was loaded in an earlier run, whatever the files hold now.
    """
    start = link.start
    if start.recorded is None:
        yield ToldHelpers(link, known)
    else:
        with sealed(start.path, start.source, known) as texts:
            yield texts
