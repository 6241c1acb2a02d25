"""Writes out what ACT-R adds to a model's text, so that tools for plain Python understand it.

Inside a production, the agent's parts, the agent itself (`self`) and the pattern's variables are known by name. They get assignments in a
line of their own before the body. A class that is a part gets a line that annotates `parent`. All other lines keep their text.
"""

from __future__ import annotations

import keyword
from bisect import bisect_left, bisect_right
from collections.abc import Iterator

from workbench.language.model_text import Method, ModelText
from workbench.language.tokens import line_of


class ExplicitText:
    """A text in which these names are assigned, and the positions that correspond to those of the model's text."""

    def __init__(self, model: ModelText) -> None:
        bodies = {method.body[0]: method for agent in model.agents.values() for method in agent.methods.values() if method.body}
        bodies = {line: method for line, method in bodies.items() if method.sees_parts}
        parents = dict(_parents(model))
        self._inserted = sorted([*bodies, *parents])
        """The lines of the model's text, counted from 1, before which a line was inserted."""
        lines: list[str] = []
        for number, line in enumerate(model.text.split("\n"), 1):
            if number in parents:
                lines.append(parents[number])
            if number in bodies:
                lines.append(_assignments(model, bodies[number]))
            lines.append(line)
        self.text = "\n".join(lines)
        self._starts = _starts(model.text)

    def place(self, at: int) -> tuple[int, int]:
        """Returns the line (from 1) and the column here of a position in the model's text."""
        line = bisect_right(self._starts, at)
        return line + bisect_right(self._inserted, line), at - self._starts[line - 1]

    def position(self, line: int, column: int) -> int | None:
        """Returns the position in the model's text of a line and a column here; None in an inserted line."""
        inserted = [at + before for before, at in enumerate(self._inserted)]
        before = bisect_left(inserted, line)
        if before < len(inserted) and inserted[before] == line:
            return None
        own = line - before
        return self._starts[own - 1] + column if own <= len(self._starts) else None


def _parents(model: ModelText) -> Iterator[tuple[int, str]]:
    """Yields for each class that is a part the line before its first method, and what it says of `parent`."""
    lines = model.text.split("\n")
    for agent in model.agents.values():
        holders = " | ".join(one.name for one in model.holders(agent.name))
        if holders and agent.methods:
            method = min(agent.methods.values(), key=lambda one: one.start)
            number = line_of(model.text, method.start)
            while number > 1 and lines[number - 2].lstrip().startswith("@"):
                number -= 1
            indented = lines[number - 1][: method.column]
            if not indented.strip():
                yield number, f'{indented}parent: "{holders}"'


def _assignments(model: ModelText, method: Method) -> str:
    assert method.body is not None
    parts = model.parts_of(method.agent)
    owners = {**dict.fromkeys(method.parameters, method.agent), **{name: part.agent for name, part in parts.items()}}
    made = [f"{name} = {owner}.{name}" for name, owner in owners.items()]
    variables = {piece.text for piece in model.variables_of(method.path)} - owners.keys()
    made += [f'{name} = ""' for name in sorted(variables) if name.isidentifier() and not keyword.iskeyword(name)]
    return f"{method.body[1]}self = {method.agent}(); {'; '.join(made)}"


def _starts(text: str) -> list[int]:
    """Returns the position of each line's first character."""
    starts = [0]
    for line in text.split("\n")[:-1]:
        starts.append(starts[-1] + len(line) + 1)
    return starts
