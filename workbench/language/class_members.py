"""Finds what a name means in a class of a text, in its bases and its subclasses: where it is defined and used, and if it is taken."""

from __future__ import annotations

import re
from collections.abc import Iterator

from workbench.language.explicit_names import ExplicitText
from workbench.language.model_text import ModelText, Name
from workbench.language.python_answers import PythonAnswers
from workbench.language.tokens import line_of

_ASSIGNED = re.compile(r"\s*(?:=(?!=)|:)")


class ClassMembers:
    """The members of the classes of a text: methods, parts, and attributes, also those that only methods set."""

    def __init__(self, model: ModelText, explicit: ExplicitText, python: PythonAnswers, path: str) -> None:
        self._model = model
        self._explicit = explicit
        self._python = python
        self._path = path
        self._known: dict[str, set[str] | None] = {}
        """The classes from which each class inherits, as far as they were asked for."""

    def meaning(self, owner: str, member: str, new: str) -> str:
        """Returns what else another name means in the classes that have a member, in their bases and in their subclasses.

        Args:
            owner: A class that has the member.
            member: The name of the member.
            new: The other name.
        """
        family = self.family(owner, member)
        related = [owner, *sorted(family - {owner}), *(base for agent in sorted(family) for base in self._model.above(agent))]
        for agent in dict.fromkeys(related):
            own = next(iter(self._own(agent, new)), None)
            if own is not None and agent == owner:
                return f"'{new}' already has a meaning in line {line_of(self._model.text, own)}"
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

    def family(self, owner: str, member: str) -> set[str]:
        """Returns the classes that have a member in common: a class, those of its bases that have it, and all subclasses of these."""
        having = [owner, *(base for base in self._model.above(owner) if self.has(base, member))]
        below = {agent for agent in self._model.agents if any(one in self._model.above(agent) for one in having)}
        more = {base for agent in below for base in self._model.above(agent) if self.has(base, member)}
        return {*having, *below, *more}

    def has(self, agent: str, member: str) -> bool:
        """Returns whether a class itself defines or uses a member."""
        return any(True for _ in self._own(agent, member))

    def may_have(self, kind: str, member: str) -> bool:
        """Returns whether objects of a class, those of other texts as `module:name`, may have a member."""
        if kind not in self._model.agents:
            return self._python.may_have(self._path, kind, member)
        return any(self.has(one, member) for one in (kind, *self._model.above(kind))) or bool(self.library(kind, member))

    def unknown_base(self, owner: str, member: str) -> tuple[str, str] | None:
        """Returns a class that has a member, and one of which it inherits without the text showing what; None if there is none."""
        for agent in sorted(self.family(owner, member)):
            for base in self._model.agents[agent].bases:
                if base not in self._model.agents and self._python.kinds_of(self._explicit, self._path, base) is None:
                    return agent, base
        return None

    def library(self, owner: str, member: str) -> str:
        """Returns what a member replaces of a class of another text, such as "a method of ACTR"; empty if it is the text's own."""
        for agent in sorted(self.family(owner, member)):
            for base in self._model.agents[agent].bases:
                kind = "" if base in self._model.agents else self._python.attribute(self._explicit, self._path, base, member)
                if kind:
                    return f"{kind} of {base}"
        return ""

    def above(self, agent: str) -> set[str] | None:
        """Returns all classes from which a class inherits, those of other texts as `module:name`; None if they are not known."""
        if agent not in self._known:
            self._known[agent] = self._find_above(agent)
        return self._known[agent]

    def _find_above(self, agent: str) -> set[str] | None:
        found = set(self._model.above(agent))
        for one in (agent, *self._model.above(agent)):
            for base in self._model.agents[one].bases:
                if base in self._model.agents:
                    continue
                more = self._python.ancestors(self._python.kinds_of(self._explicit, self._path, base))
                if more is None:
                    return None
                found |= more
        return found | {"builtins:object"}

    def above_all(self, family: set[str]) -> set[str] | None:
        """Returns all classes from which some classes inherit; None if they are not known."""
        found: set[str] = set()
        for agent in family:
            more = self.above(agent)
            if more is None:
                return None
            found |= more
        return found

    def kinds(self, name: Name) -> set[str] | None:
        """Returns the classes of what stands before a name, those of other texts as `module:name`; None if they are not known."""
        if name.before in (("self",), ("self", "__class__")) and name.agent:
            return {name.agent}
        kinds = self._python.kinds(self._explicit, self._path, self._explicit.place(name.start - 1))
        return None if kinds and "typing:Self" in kinds else kinds

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
