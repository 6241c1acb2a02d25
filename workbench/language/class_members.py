"""Finds what a name means in a class of a text, in its bases and its subclasses: where it is defined and used, and if it is taken."""

from __future__ import annotations

import re
from collections.abc import Iterator

from workbench.language.answers import LanguageError
from workbench.language.explicit_names import ExplicitText
from workbench.language.model_text import ModelText, Name
from workbench.language.python_answers import PythonAnswers

_ASSIGNED = re.compile(r"\s*(?:=(?!=)|:)")


class ClassMembers:
    """The members of the classes of a text: methods, parts, and attributes, also those that only methods set.

    Args:
        model: The text.
        explicit: The same, with what ACT-R adds to it.
        python: Answers questions about plain Python.
        path: The file of the text.
    """

    def __init__(self, model: ModelText, explicit: ExplicitText, python: PythonAnswers, path: str) -> None:
        self._model = model
        self._explicit = explicit
        self._python = python
        self._path = path

    def owner(self, name: Name) -> str:
        """Returns the class of the text of which a name is a member; empty if it is a member of none."""
        if name.before == ("self",) and name.agent:
            return name.agent
        found = self._kinds(name) if name.before else {self._python.owner(self._explicit, self._path, name.start)}
        return next((kind for kind in found or () if kind in self._model.agents), "")

    def places(self, owner: str, member: str) -> set[int]:
        """Returns where a member of a class is defined and used, also by classes that inherit it or pass it on.

        Raises:
            LanguageError: If it is not known of a place whether it is the same member.
        """
        family = self._sharing(owner, member)
        found = {start for agent in family for start in self._own(agent, member)}
        for name in self._model.names:
            if name.text != member or not name.before or name.start in found or (name.before == ("self",) and name.agent):
                continue
            kinds = self._kinds(name)
            if kinds is None:
                line = self._model.text.count("\n", 0, name.start) + 1
                raise LanguageError(f"'{member}' cannot be renamed: whether '{member}' in line {line} is the same is not known")
            if kinds & family:
                found.add(name.start)
        return found

    def meaning(self, owner: str, member: str, new: str) -> str:
        """Returns what else another name means in the classes that have a member, in their bases and in their subclasses.

        Args:
            owner: A class that has the member.
            member: The name of the member.
            new: The other name.
        """
        family = self._sharing(owner, member)
        related = [owner, *sorted(family - {owner}), *(base for agent in sorted(family) for base in self._above(agent))]
        for agent in dict.fromkeys(related):
            own = next(iter(self._own(agent, new)), None)
            if own is not None and agent == owner:
                return f"'{new}' already has a meaning in line {self._model.text.count(chr(10), 0, own) + 1}"
            if own is not None:
                kind = "a method" if new in self._model.agents[agent].methods else "an attribute"
                return f"'{new}' is {kind} of {agent} already"
            for base in self._model.agents[agent].bases:
                if base in self._model.agents:
                    continue
                if new.startswith("_"):
                    return f"'{new}' may be a private name of {base}"
                kind = self._python.attribute(self._explicit, self._path, base, new)
                if kind:
                    return f"'{new}' is {kind} of {base} already"
        return ""

    def _sharing(self, owner: str, member: str) -> set[str]:
        """Returns the classes that have a member in common: a class, those of its bases that have it, and all subclasses of these."""
        having = [owner, *(base for base in self._above(owner) if any(True for _ in self._own(base, member)))]
        below = {agent for agent in self._model.agents if any(one in self._above(agent) for one in having)}
        more = {base for agent in below for base in self._above(agent) if any(True for _ in self._own(base, member))}
        return {*having, *below, *more}

    def _above(self, agent: str) -> list[str]:
        """Returns the classes of the text from which a class inherits."""
        found: list[str] = []
        waiting = list(self._model.agents[agent].bases)
        while waiting:
            base = waiting.pop(0)
            if base in self._model.agents and base not in found:
                found.append(base)
                waiting += self._model.agents[base].bases
        return found

    def _own(self, agent: str, member: str) -> Iterator[int]:
        """Yields where a class itself defines a name, and where its methods use it as an attribute of `self`."""
        one, text = self._model.agents[agent], self._model.text
        if member in one.methods:
            yield one.methods[member].start
        for name in self._model.names:
            if name.text != member or name.agent != agent:
                continue
            begins = not text[text.rfind("\n", 0, name.start) + 1 : name.start].strip()
            if name.before == ("self",) or (not name.method and not name.before and begins and _ASSIGNED.match(text, name.end)):
                yield name.start

    def _kinds(self, name: Name) -> set[str] | None:
        """Returns the classes of what stands before a name, those of other texts as empty; None if they are not known."""
        part = self._model.parts_of(name.agent).get(name.before[-1]) if name.before[:-1] in ((), ("self",), ("self", "parent")) else None
        if part is not None and part.kind in self._model.agents:
            return {part.kind}
        return self._python.kinds(self._explicit, self._path, name.start - 1)
