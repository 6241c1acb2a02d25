"""Text output: a mouth that prints."""

from __future__ import annotations

from actr3d.actr.model import Model


class TextOutput(Model):
    """Prints what an agent writes."""

    def write(self, text: object) -> None:
        """Prints and logs a text."""
        print(text)
        self.log._ = text
