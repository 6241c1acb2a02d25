"""Text output: a mouth that prints."""

from __future__ import annotations

from actr3d.actr.model import Model


class TextOutput(Model):
    """Prints what an agent writes."""

    def write(self, text: object) -> None:
        """Prints and logs a text."""
        print(text)  # noqa: T201 - this is what the module is for
        self.log._ = text
