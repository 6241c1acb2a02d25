"""Text output: prints what an agent says."""

from __future__ import annotations

from actr3d.actr.kernel.log import log_line
from actr3d.actr.kernel.model import Model
from actr3d.actr.modules.registry import module


@module
class TextOutput(Model):
    """Prints what an agent writes."""

    def write(self, text: object) -> None:
        """Prints and logs a text."""
        print(text)  # noqa: T201 - this is what the module is for
        log_line(self.log, text)
