"""Finds all words of a text that mean the same as one of them, and those of which that is not known."""

from __future__ import annotations

import builtins
import keyword
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

from actr3d.actr.kernel.read_attributes import READ, readers_of
from actr3d.actr.lint.slot_names import GIVERS, READERS
from workbench.language import actr_answers
from workbench.language.answers import LanguageError, Renaming
from workbench.language.class_members import ClassMembers
from workbench.language.explicit_names import ExplicitText
from workbench.language.library_words import gives_joints, joints, slots_given
from workbench.language.model_text import ChunkText, Method, ModelText, Name, Part, Piece, Written
from workbench.language.python_answers import PythonAnswers
from workbench.language.scopes import Scope, Scopes
from workbench.language.tokens import line_of

_MEMBER = r"""["'][\w.]*\.({0})\b[\w.]*["']|\b(?:get|set|has|del)attr\([^()\n]*,\s*["']({0})["']|["']({0})["'](?:\s*:|\]\s*=(?!=))"""
"""A member in a string: "walker.speed", getattr(self, "speed"), {"speed": 1}, values["speed"] = 1."""
_SLOT = r"""(?<![^\s"'])({0}):(?![\s"'=])"""
"""A slot and its value in a string."""
_STRINGS = {"member": _MEMBER, "slot": _SLOT, "variable": r"\?({0})\b"}
_NAMES = re.compile(r"[\s,;|/]*\w[\w.]*(?:[\s,;|/]+\w[\w.]*)*[\s,;|/]*")
"""Names that a program may separate: "weight colour", "weight,colour"."""
_QUOTES = ("'", '"')
_PLANNING_UNITS = {"actr3d.sgoms.units:Ordered", "actr3d.sgoms.units:Situated"}
_MODEL = "actr3d.actr.kernel.model:Model"
_FEATURE = "actr3d.vision.feature:Feature"
_BUFFER = "actr3d.actr.kernel.buffer:Buffer"


@dataclass(frozen=True, kw_only=True)
class Meaning:
    """What a word means."""

    what: str
    """`variable` of a production, `slot`, `local` of a scope, or `member` of a class."""
    owners: frozenset[object] = frozenset()
    """The production, the scope, or the classes that an object may have, those of other texts as `module:name`."""


@dataclass(frozen=True, kw_only=True)
class WordPlace:
    """One place of a word: a name in the code, or a slot or a variable in a text of a chunk or pattern."""

    start: int
    name: Name | None
    meaning: Meaning | None
    """None if it is not known."""


_LIBRARY = Meaning(what="local", owners=frozenset({"library"}))


class References:
    """The words of a text, and what they mean."""

    def __init__(self, model: ModelText, python: PythonAnswers, path: str) -> None:
        self.model = model
        self.explicit = ExplicitText(model)
        self.members = ClassMembers(model, self.explicit, python, path)
        self._python = python
        self._path = path
        self._kinds_of_parts: dict[str, set[str] | None] = {}

    @cached_property
    def _scopes(self) -> Scopes:
        return Scopes(self.explicit.text)

    def uses(self, at: int) -> Renaming:
        """Returns all places of what the word at a position means.

        Raises:
            LanguageError: If there is none, if it belongs to another text, or if it is not known of a place whether it is the same.
        """
        text, name = self.model.text_at(at), self.model.name_at(at)
        if text is not None:
            found = next((one for one in (*text.slots, *self._variables(text)) if one.start - 1 <= at <= one.end), None)
            if found is None:
                raise LanguageError("there is no name here that can be renamed")
            word, start = found.text, found.start
        elif name is not None and not keyword.iskeyword(name.text):
            word, start = name.text, name.start
            self._check_name(name)
        else:
            raise LanguageError("there is no name here that can be renamed")
        target = next(one for one in self._words(word) if one.start == start)
        meaning = target.meaning
        unknown = f"'{word}' cannot be renamed: where it is defined is not known"
        if meaning is None and name is not None and not name.before and not (name.keyword and name.called):
            self._check_members([one.name for one in self.model.lineage(name.agent)], word, start)
        if meaning is None or meaning == _LIBRARY:
            raise LanguageError(unknown)
        if meaning.what == "slot":
            self._check_slot(word, start)
        what = "name" if meaning.what in ("local", "member") else meaning.what
        if meaning.what == "member":
            own = sorted(str(one) for one in meaning.owners if one in self.model.agents)
            if not own:
                kind = next(iter(sorted(str(one) for one in meaning.owners if one)), "").replace(":", ".").lstrip(".")
                raise LanguageError(f"'{word}' is defined in {kind}, and keeps its name here" if kind else unknown)
            self._check_members(own, word, start)
            if self._is_part(word, meaning):
                what = "part"
        starts, unproven = self.places(word, start)
        if unproven:
            line = self._line(min(unproven))
            shown = self._written(min(unproven)) or word
            raise LanguageError(f"'{word}' cannot be renamed: whether '{shown}' in line {line} is the same is not known", line=line)
        if (
            meaning.what == "member"
            and what != "part"
            and not any(self._scopes.is_definition(self.explicit.place(start)) for start in starts)
        ):
            raise LanguageError(unknown)
        return Renaming(name=word, what=what, starts=sorted(starts))

    def places(self, word: str, start: int) -> tuple[set[int], set[int]]:
        """Returns the places of what a word means at one of them, and those of which it is not known whether they are the same."""
        words = list(self._words(word))
        target = next(one for one in words if one.start == start)
        found = {one.start: self._is_same(word, target, one) for one in words}
        same, unproven = ({at for at, one in found.items() if one is answer} for answer in (True, None))
        assert target.meaning is not None
        strings = self._in_strings(_STRINGS.get(target.meaning.what, ""), word)
        seen = any(self._is_seen_as_chunk(kind) for kind in target.meaning.owners) if target.meaning.what == "member" else False
        if seen:
            strings |= self._in_strings(_SLOT, word)
        computed = self._may_be_in_strings(word, target)
        if seen or target.meaning.what == "slot" or computed:
            strings |= self._as_values(word)
        elif target.meaning.what == "member":
            values = {at for at in self._as_values(word) if self._scopes.may_name_member(self.explicit.place(at))}
            whole = {at for at in values if (at, at + len(word)) in self.model.other_texts}  # strings that hold nothing but the word
            strings |= values if self._is_part(word, target.meaning) else whole
        if target.meaning.what == "variable":
            strings = {at for at in strings if self._may_be_used(at, target.meaning)}
        if self._is_feature(word, target.meaning):  # which requests and patterns name in lower case: feature:pole
            named = re.finditer(rf"""\b(?:feature:|feature\s*=\s*["']|DETECTORS\[["']){re.escape(word.lower())}\b""", self.model.text)
            strings |= {one.end() - len(word) for one in named}
        fetched = computed and self._is_part(word, target.meaning)  # getattr(self.parent, what)
        if fetched or self._is_planning_unit(word, target.meaning):  # SGOMS names these by values: planning_unit:squeeze
            values = (piece.start for text in self.model.texts for piece in text.pieces if piece.text == word and not piece.is_variable)
            strings |= {*values, *self._as_values(word)}
        return same, unproven | (strings - same)

    def _line(self, at: int) -> int:
        return line_of(self.model.text, at)

    def _may_be_in_strings(self, word: str, target: WordPlace) -> bool:
        """Returns whether a name may be computed: that of a parameter for `f(**values)`, or of a member for `getattr(one, name)`."""
        assert target.meaning is not None
        if target.meaning.what != "member":
            function = self._scopes.function_with_parameter(self.explicit.place(target.start))
            called = self._scopes.called_with_names
            return function is not None and bool(called if function in ("", "__init__") else called & {"", function})
        own = [str(kind) for kind in target.meaning.owners if kind in self.model.agents]
        family = {one for kind in own for one in self.members.family(kind, word)}
        asked = (self._python.kinds(self.explicit, self._path, place) for place in self._scopes.asked_by_name)
        return any(kinds is None or kinds & {*family, *(self.members.above_all(family) or kinds)} for kinds in asked)

    def _written(self, at: int) -> str:
        """Returns what stands around a position in a string without a space, such as `walker.speed`; empty if it is in none."""
        begin, end = next(((begin, end) for begin, end in self.model.other_texts if begin <= at < end), (at, at))
        return next((one[0] for one in re.compile(r"\S+").finditer(self.model.text, begin, end) if one.end() > at), "")

    def _is_part(self, word: str, meaning: Meaning) -> bool:
        return next(self._parts(word, meaning), None) is not None

    def _is_planning_unit(self, word: str, meaning: Meaning) -> bool:
        return any(_PLANNING_UNITS & (self._of_part(part)[1] or _PLANNING_UNITS) for part in self._parts(word, meaning))

    def _is_feature(self, word: str, meaning: Meaning) -> bool:
        """Returns whether a name is that of a class of things that vision finds."""
        if meaning.what != "local" or word not in self.model.agents:
            return False
        return "Feature" in self._names_of_bases(word) or _FEATURE in (self.members.above(word) or ())

    def _names_of_bases(self, kind: str) -> set[str]:
        """Returns the names, without modules, of the classes of which a class of the text and those above it inherit."""
        return {base.rpartition(".")[2] for one in self.model.lineage(kind) for base in one.bases}

    def _parts(self, word: str, meaning: Meaning) -> Iterator[Part]:
        """Yields the parts that a member means."""
        own = [str(one) for one in meaning.owners if one in self.model.agents] if meaning.what == "member" else []
        agents = [self.model.agents[one] for agent in own for one in sorted(self.members.family(agent, word))]
        yield from (agent.parts[word] for agent in agents if word in agent.parts)

    def _may_be_used(self, at: int, variable: Meaning) -> bool:
        """Returns whether a production of a variable has the text at a position, itself or by the name of a constant."""
        before = next((name for name in reversed(self.model.names) if name.start < at), None)
        if before is None or before.method:
            return before is not None and before.method in variable.owners
        return any(one.text == before.text and one.method in variable.owners for one in self.model.names)

    def _in_strings(self, pattern: str, word: str) -> set[int]:
        """Returns where a word stands in strings that are no known texts of chunks or patterns, in the way that a pattern describes."""
        if not pattern:
            return set()
        places = {one.start(one.lastindex or 0) for one in re.finditer(pattern.format(re.escape(word)), self.model.text)}
        known = [(one.start, one.end) for one in self.model.texts]
        return {
            at
            for at in places
            if any(begin <= at < end for begin, end in self.model.other_texts) and not any(begin <= at < end for begin, end in known)
        }

    def _as_values(self, word: str) -> set[int]:
        """Returns where a word stands in strings that hold only names, at the beginning of one: "memory", "memory.request goal"."""
        text, known = self.model.text, {(one.start, one.end) for one in self.model.texts}
        whole = (
            (begin, end) for begin, end in self.model.other_texts if text[begin - 1 : begin] in _QUOTES and text[end : end + 1] in _QUOTES
        )
        lists = [(begin, end) for begin, end in whole if (begin, end) not in known and _NAMES.fullmatch(text, begin, end)]
        lists = [(begin, end) for begin, end in lists if not self._scopes.is_printed(self.explicit.place(begin))]
        return {one.start() for begin, end in lists for one in re.compile(rf"(?<![\w.]){re.escape(word)}\b").finditer(text, begin, end)}

    def owner(self, at: int) -> str:
        """Returns the class of the text of which the word at a position is a member; empty if it is a member of none."""
        name = self.model.name_at(at)
        found = None if name is None or self.model.text_at(at) is not None else self._of_name(name)
        return "" if found is None or found.what != "member" else min(str(one) for one in found.owners if one in self.model.agents)

    def mentions(self, word: str) -> bool:
        """Returns whether a word is anywhere in the text."""
        return any(True for _ in self._words(word))

    # -- what words mean

    def _words(self, word: str) -> Iterator[WordPlace]:
        """Yields all words of a text."""
        for text in self.model.texts:
            for slot in text.slots:
                if slot.text == word:
                    yield WordPlace(start=slot.start, name=None, meaning=self._of_slot(text, slot))
                elif word in slot.text.split("."):  # it names something that the path leads to
                    yield WordPlace(start=slot.start + f".{slot.text}.".index(f".{word}."), name=None, meaning=None)
            for piece in self._variables(text):
                if piece.text == word:
                    yield WordPlace(start=piece.start, name=None, meaning=Meaning(what="variable", owners=frozenset({text.method})))
        for found in re.finditer(rf"(\w+|[\])])\[[\"']({re.escape(word)})[\"']\]", self.model.text):
            is_class = found[1] in self.model.agents  # of an Enum
            is_chunk = found[1] == "chunk" or any(found[1] in one.parts for one in self.model.agents.values())
            known = Meaning(what="member", owners=frozenset({found[1]})) if is_class else Meaning(what="slot") if is_chunk else None
            yield WordPlace(start=found.start(2), name=None, meaning=known)  # other things with keys are not known to be chunks
        for name in self.model.names:
            if name.text == word:
                yield WordPlace(start=name.start, name=name, meaning=self._of_name(name))

    @staticmethod
    def _variables(text: ChunkText) -> list[Piece]:
        return [piece for piece in text.pieces if piece.is_variable]

    def _of_slot(self, text: ChunkText, slot: Written) -> Meaning | None:
        """Returns the meaning of a slot in a text: an attribute in a pattern of a module or of the agent; None if it is not known."""
        if "." in slot.text:  # a path
            return None
        if text.kind != "pattern" or not slot.text.isidentifier():
            return Meaning(what="slot")
        if text.part == "self":
            return Meaning(what="member", owners=frozenset({text.agent}))
        if self._is_set_elsewhere(text.agent, text.part):
            return None
        meanings = [self._of_attribute(text, part) for part in self.model.may_be(text.agent, text.part)]
        kinds = {None if one is None else one.what for one in meanings}
        if len(kinds) > 1 or None in kinds:
            return None
        return Meaning(what=kinds.pop() or "", owners=frozenset[object]().union(*(one.owners for one in meanings if one is not None)))

    def _is_set_elsewhere(self, agent: str, part: str) -> bool:
        """Returns whether the text sets a part of an agent other than by `part = Kind(...)` in the body of a class: it may be anything."""
        own = {one.name for one in self.model.lineage(agent)} | {one for one in self.model.agents if agent in self.model.above(one)}
        made = {one.parts[part].start for one in self.model.agents.values() if part in one.parts}
        for name in self.model.names:
            if name.text != part or (name.before in ((), ("self",)) and name.agent not in own and not name.keyword):
                continue
            place = self.explicit.place(name.start)
            given = name.keyword and name.called[-1:] and name.called[-1] in self.model.agents
            bound = (name.before or not name.method) and self._scopes.is_definition(place)
            if given or (bound and not (name.start in made and self._scopes.is_made_by_call(place))):
                return True
        return bool(self._in_strings(_MEMBER, part))

    def _of_attribute(self, text: ChunkText, part: Part | None) -> Meaning | None:
        """Returns the meaning of a slot in a pattern of a part; None if it is not known."""
        if part is None:  # of a class of the library; otherwise, of what the agent is put into
            return Meaning(what="slot") if self.members.library(text.agent, text.part) else None
        if part.kind == "Buffer" and "Buffer" not in self.model.agents:
            return Meaning(what="slot")
        kinds, above = self._of_part(part)
        if kinds is None or above is None:
            return None
        return Meaning(what="slot") if _BUFFER in above else Meaning(what="member", owners=frozenset(kinds))

    def _of_part(self, part: Part) -> tuple[set[str] | None, set[str] | None]:
        """Returns the classes that a part may have, and all from which these inherit; None if they are not known."""
        own = part.kind in self.model.agents
        expression = f"{part.agent}.{part.name}"
        if expression not in self._kinds_of_parts:
            found = {part.kind} if own else self._python.kinds_of(self.explicit, self._path, expression)
            self._kinds_of_parts[expression] = found
        kinds = self._kinds_of_parts[expression]
        return kinds, self.members.above(part.kind) if own else self._python.ancestors(kinds)

    def _of_name(self, name: Name) -> Meaning | None:
        place = self.explicit.place(name.start)
        if self._scopes.is_import_path(place):
            return _LIBRARY
        if actr_answers.is_variable(self.model, name):
            return Meaning(what="variable", owners=frozenset({name.method}))
        part = actr_answers.part_of(self.model, name)
        if part is not None:
            return Meaning(what="member", owners=frozenset({part.agent}))
        if name.before:
            kinds = self.members.kinds(name)
            return None if kinds is None else Meaning(what="member", owners=frozenset(kinds))
        if name.keyword and name.called:
            return self._of_argument(name)
        scope, method = self._scopes.of(place), self.model.method(name.method)
        if method is not None and method.sees_parts and method.start != name.start:
            return self._of_name_in_production(name, method, scope)
        if scope is None:
            return _LIBRARY
        kind, owner, _ = scope
        return Meaning(what="member", owners=frozenset({owner})) if kind == "class" else Meaning(what="local", owners=frozenset({scope}))

    def _of_name_in_production(self, name: Name, method: Method, scope: Scope | None) -> Meaning | None:
        """Returns the meaning of a name in a production, which sees the attributes of its agent."""
        if scope is None or scope[0] == "module":
            holders = {one.name for one in self.model.lineage(name.agent) if self._binds(one.name, name.text)}
            if holders:
                return Meaning(what="member", owners=frozenset(holders))
        if scope is None:
            return _LIBRARY if hasattr(builtins, name.text) else None
        if scope[:2] == ("function", method.name) and name.text in method.parameters:
            return None  # a part that the text does not define
        return Meaning(what="local", owners=frozenset({scope}))

    def _binds(self, agent: str, word: str) -> bool:
        """Returns whether the body of a class defines a name."""
        places = (self.explicit.place(one.start) for one in self.model.names if one.text == word and one.agent == agent and not one.before)
        return any((self._scopes.of(place) or ("",))[:2] == ("class", agent) for place in places)

    def _of_argument(self, name: Name) -> Meaning | None:
        """Returns the meaning of `width` in `look(width=1)`: a parameter of the function, a field of the class, or a slot."""
        if actr_answers.is_modified(name):
            return Meaning(what="slot")
        if not self._is_known(name):
            return None
        found = [one.at for one in self._python.definitions(self.explicit, self._path, name.start)]
        if found and all(at is None for at in found):
            return _LIBRARY
        others = [self.model.name_at(at) for at in found if at is not None]
        meanings = {self._of_name(one) for one in others if one is not None and one.text == name.text and not (one.keyword and one.called)}
        if meanings:
            replaced = any(one is not None and self._is_replaced(one) for one in others)
            return None if replaced or None in found or len(meanings) > 1 else meanings.pop()
        before = [one for one in self.model.names if one.end <= name.start and (*one.before, one.text) == name.called]
        kinds = self.members.kinds(before[-1]) if before and before[-1].before else None
        known = bool(kinds) and all(":" in kind and not kind.endswith(":") for kind in kinds or ())
        is_method = known and all(self.members.may_have(kind, name.called[-1]) for kind in kinds or ())  # not one of `self.parent`
        return _LIBRARY if is_method else None  # a method of an object of the library knows no names of the text

    def _is_replaced(self, parameter: Name) -> bool:
        """Returns whether another class of the same members has the same method, with a parameter of the same name."""
        owner, _, method = parameter.method.rpartition(".")
        family = self.members.family(owner, method) - {owner} if owner and method != "__init__" else set[str]()
        found = (self.model.agents[one].methods.get(method) for one in family)
        return any(one is not None and parameter.text in one.parameters for one in found)

    def _is_known(self, argument: Name) -> bool:
        """Returns whether the function that a call with a keyword argument calls is known; a variable may hold any."""
        if len(argument.called) > 1:
            return True
        called = next((one for one in reversed(self.model.names) if one.start < argument.start and (one.text,) == argument.called), None)
        return called is not None and self._scopes.is_function_or_class(self.explicit.place(called.start))

    # -- which are the same

    def _is_same(self, word: str, target: WordPlace, other: WordPlace) -> bool | None:
        """Returns whether two places of a word mean the same; None if it is not known."""
        one, two = target.meaning, other.meaning
        assert one is not None
        if other.start == target.start and one.what != "member":
            return True
        if two is None:
            return self._may_be(word, target, other)
        asked = other.name is not None and other.name.keyword and other.name.called[-1:] and other.name.called[-1] in (*GIVERS, *READERS)
        if one.what == "slot" and asked and two.what != "slot":
            return None
        if (asked or two.what == "slot") and self._scopes.is_parameter_of_decorated(self.explicit.place(target.start)):
            return None  # requests name the parameters of detectors
        if {one.what, two.what} == {"slot", "member"}:
            return None if any(self._is_seen_as_chunk(kind) for kind in one.owners | two.owners) else False
        if one.what != two.what:
            return False
        if one.what != "member":
            return one.owners == two.owners
        owner = min(str(kind) for kind in one.owners if kind in self.model.agents)
        family = self.members.family(owner, word)
        if two.owners & family:
            return None if any(self.members.may_have(str(kind), word) for kind in two.owners - family) else True
        above = self.members.above_all(family)
        unknown = above is None and any(":" in str(kind) and not str(kind).startswith("builtins:") for kind in two.owners)
        return None if unknown or two.owners & (above or set()) else False

    def _may_be(self, word: str, target: WordPlace, other: WordPlace) -> bool | None:
        """Returns False if a word whose meaning is not known cannot mean the same as another; None if it can."""
        one, name = target.meaning, other.name
        assert one is not None
        if name is None:  # it belongs to a part whose class is not known
            return None if one.what in ("slot", "member") else False
        if not name.called or not name.keyword:
            method = self.model.method(name.method)
            matched = method is not None and method.sees_parts and word in method.parameters  # in a pattern of what the text does not show
            seen = name.before or matched or self._is_part(word, one) or self._is_seen(word, one, name)
            return None if one.what == "member" and seen else False
        if one.what == "local":
            function = self._scopes.function_with_parameter(self.explicit.place(target.start))
            made = self.model.agents.get(name.called[-1]) if len(name.called) == 1 and function != "__init__" else None
            makes = made is not None and not any("__init__" in one.methods for one in self.model.lineage(made.name))
            return False if function is None or makes else None  # a class that only the library's `__init__` makes calls no other function
        return False if one.what == "variable" else None

    def _is_seen(self, word: str, member: Meaning, name: Name) -> bool:
        """Returns whether a production may see a member by its bare name: if its agent has it, or a class above or below that one."""
        seen = {one.name for one in self.model.lineage(name.agent)}
        family = {one for kind in member.owners if kind in self.model.agents for one in self.members.family(str(kind), word)}
        return any(one in seen for kind in family for one in (kind, *self.model.above(kind)))

    def _is_seen_as_chunk(self, kind: object) -> bool:
        """Returns whether vision may make a chunk of a thing of this class, with its attributes as slots."""
        if kind not in self.model.agents:
            return False
        above = self.members.above(str(kind))
        if self._names_of_bases(str(kind)) & {"Feature", "Model"} or above is None:
            return True
        return _MODEL in above and any(issubclass(one, readers_of("visible")) for one in self._library_classes)  # an agent, too

    # -- what may not be renamed

    def _check_name(self, name: Name) -> None:
        if name.text.startswith("__") and name.text.endswith("__"):
            raise LanguageError(f"'{name.text}' has a meaning in Python, and keeps its name")
        method = self.model.method(name.method)
        if name.text == "self" and not name.before and method is not None and method.sees_parts:
            raise LanguageError("'self' is the agent in every production, and keeps its name")
        if name.text == "build" and (self._scopes.of(self.explicit.place(name.start)) or ("",))[0] == "module":
            raise LanguageError("'build' is called to make the simulation, and keeps its name")
        acts = actr_answers.is_variable(self.model, name) or actr_answers.part_of(self.model, name) or actr_answers.is_modified(name)
        defined = None if acts else self._python.define(self.explicit, self._path, name.start)
        if defined is not None and defined.at is None:
            raise LanguageError(f"'{name.text}' is defined in {defined.path or defined.module}, and keeps its name here")

    def _check_members(self, agents: list[str], word: str, at: int) -> None:
        for agent in agents:
            of_library = self.members.library(agent, word)
            if of_library:
                raise LanguageError(f"'{word}' is {of_library}, and keeps its name here", line=self._line(at))
            unknown = self.members.unknown_base(agent, word)
            if unknown is not None:
                line = self._line(self.model.agents[unknown[0]].start)
                raise LanguageError(f"'{word}' cannot be renamed: what {unknown[0]} inherits in line {line} is not known", line=line)
        self._check_read(word, at)

    def _check_read(self, word: str, at: int) -> None:
        readers = readers_of(word)
        reader = next((kind for kind in (self._library_classes if readers else ()) if issubclass(kind, readers)), None)
        if reader is not None:
            raise LanguageError(f"'{word}' is read by {reader.__name__}, and keeps its name here", line=self._line(at))

    @cached_property
    def _library_classes(self) -> list[type]:
        """The classes of the library that the text has as parts or bases, and those it names that read attributes of its objects."""
        agents = self.model.agents.values()
        named = {part.kind: f"{one.name}.{part.name}" for one in agents for part in one.parts.values()}
        named |= {base: base for one in agents for base in one.bases}
        reading = {kind.__name__ for kind in READ}
        paths = (".".join((*one.before, one.text)) for one in self.model.names if one.text in reading)
        named |= {path: path for path in paths}
        expressions = [expression for kind, expression in named.items() if kind not in self.model.agents]
        found = (self._python.classes_of(self.explicit, self._path, expression) for expression in expressions)
        return list(dict.fromkeys(kind for kinds in found for kind in kinds))

    def _is_given(self, slot: str) -> bool:
        """Returns whether the text itself gives a slot to chunks."""
        named = any(one.text == slot for text in self.model.texts if text.kind == "chunk" for one in text.slots)
        return named or any(one.text == slot and actr_answers.is_modified(one) for one in self.model.names)

    def _check_slot(self, slot: str, at: int) -> None:
        if re.fullmatch(r"_?\d+", slot):
            raise LanguageError(f"'{slot}' is the position of a value without a slot, and keeps its name")
        for text in self.model.texts:
            if any(one.text == slot for one in text.slots):
                word = actr_answers.giver(self.model, text, slot)
                if word:
                    raise LanguageError(f"'{slot}' is a slot of '{word}', and keeps its name here", line=self._line(at))
        for kind in self._library_classes:
            if slot in slots_given(kind):
                raise LanguageError(f"'{slot}' is a slot of {kind.__name__}, and keeps its name here", line=self._line(at))
            if gives_joints(kind) and (slot in joints() or not self._is_given(slot)):
                raise LanguageError(
                    f"'{slot}' may be a joint in the chunks of {kind.__name__}, and keeps its name here", line=self._line(at)
                )
        self._check_read(slot, at)
