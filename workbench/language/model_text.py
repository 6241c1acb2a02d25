"""Reads a model's text, which may be incomplete: its agents, their parts and productions, and all texts of chunks and patterns."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property

from actr3d.actr.lint.slot_names import GIVERS, READERS
from workbench.language.tokens import CodeToken, tokens_of

_WORD = re.compile(r"\S+")
_SLOT = re.compile(r"(\??[\w.]+):")
_PIECE = re.compile(r"(!?\??)([\w.-]*)")


@dataclass(frozen=True, kw_only=True)
class Written:
    """Some characters of the text, such as the name of a slot, and where they stand."""

    text: str
    start: int

    @property
    def end(self) -> int:
        """Where they end."""
        return self.start + len(self.text)


@dataclass(frozen=True, kw_only=True)
class Name(Written):
    """A name in the code, with what stands around it."""

    before: tuple[str, ...]
    """The names before it: `self`, `goal` in `self.goal.modify`."""
    keyword: bool
    """Whether it names a parameter: `number=` in a call or in the head of a function."""
    called: tuple[str, ...]
    """The function in whose parentheses it stands directly; empty for none."""
    agent: str
    """The class around it; empty outside of classes."""
    method: str
    """The method around it, as `agent.name`; empty outside of methods."""


@dataclass(frozen=True, kw_only=True)
class Piece(Written):
    """One constant or variable in a text, such as `?now` in `number:?now`."""

    sign: str
    """What stands before it: `?`, `!`, `!?` or nothing."""
    slot: str
    """The name of its slot, or the number."""

    @property
    def is_variable(self) -> bool:
        """Whether it is a variable."""
        return self.sign.endswith("?")


@dataclass(frozen=True, kw_only=True)
class ChunkText(Written):
    """A text that describes a chunk or a pattern; an f-string with computed values has several."""

    kind: str
    """`pattern` of a production, `chunk` that is set or added, or `request`."""
    part: str
    """The buffer or module that it is about."""
    agent: str
    method: str
    slot: str = ""
    """The slot whose value it is: `left` in `request("feature:opening", left="?left")`; empty if it names its slots."""

    @cached_property
    def slots(self) -> tuple[Written, ...]:
        """The names of slots in it."""
        if self.slot:
            return ()
        found = ((word, _SLOT.match(word[0])) for word in _WORD.finditer(self.text))
        return tuple(Written(text=slot[1], start=self.start + word.start()) for word, slot in found if slot and slot[1][0] != "?")

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """The constants and variables in it."""
        return tuple(self._pieces())

    def _pieces(self) -> Iterator[Piece]:
        for place, word in enumerate(_WORD.finditer(self.text)):
            slot = None if self.slot else _SLOT.match(word[0])
            name, at = (slot[1], slot.end()) if slot else (self.slot or str(place), 0)
            if name[0] == "?":
                yield Piece(sign="?", text=name[1:], start=self.start + word.start() + 1, slot=name)
            for piece in _PIECE.finditer(word[0], at):
                if piece[2]:
                    yield Piece(sign=piece[1], text=piece[2], start=self.start + word.start() + piece.start(2), slot=name)


@dataclass(frozen=True, kw_only=True)
class Part:
    """A buffer or module of an agent, as its class creates it."""

    name: str
    kind: str
    """Its class, such as `Buffer`."""
    agent: str
    given: list[str]
    """The names that it is made with, such as its buffer."""
    start: int


@dataclass(kw_only=True)
class Method:
    """A method of a class."""

    name: str
    agent: str
    start: int
    column: int
    parameters: dict[str, bool] = field(default_factory=dict[str, bool])
    """Its parameters in order, and whether each has a default."""
    body: tuple[int, str] | None = None
    """The number and the indentation of the first line of its body; None if there is none yet, or it is on the line of its head."""

    @property
    def sees_parts(self) -> bool:
        """Whether it knows the agent's parts by name: it is a production, or has no parameters."""
        return all(self.parameters.values())

    @property
    def path(self) -> str:
        """Its agent and its name."""
        return f"{self.agent}.{self.name}"


@dataclass(kw_only=True)
class Agent:
    """A class with its parts and methods: an agent, a module, or any other."""

    name: str
    """Its name, after those of the classes around it."""
    start: int
    bases: list[str] = field(default_factory=list[str])
    parts: dict[str, Part] = field(default_factory=dict[str, Part])
    methods: dict[str, Method] = field(default_factory=dict[str, Method])


@dataclass(kw_only=True)
class _Bracket:
    """An open bracket: of a function's head (`def`), a class's head (`class`), a `call`, or any other."""

    kind: str
    names: tuple[str, ...] = ()
    keyword: str = ""
    """The parameter whose value comes next."""
    place: int = 0
    """The number of commas up to here."""
    part: Part | None = None


@dataclass(frozen=True, kw_only=True)
class _Block:
    """A class or function that is not over yet."""

    kind: str
    name: str
    column: int


class ModelText:
    """What the text of a model says, as far as it can be read."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.agents: dict[str, Agent] = {}
        self.texts: list[ChunkText] = []
        self.names: list[Name] = []
        self._tokens = list(tokens_of(text))
        self._brackets: list[_Bracket] = []
        self._blocks: list[_Block] = []
        self._statement = 0
        """The number of the first token of the present statement."""
        self._headed: Method | None = None
        """The method whose body comes next."""
        for number, token in enumerate(self._tokens):
            self._take(number, token)
        self.texts = [one for one in self.texts if self._describes(one)]

    @cached_property
    def other_texts(self) -> list[tuple[int, int]]:
        """Where the texts that stand in a statement begin and end: all strings but docstrings."""
        tokens = [
            token for number, token in enumerate(self._tokens) if not (token.first and self._text(number + 1)[:1] in ("\n", "\r", ""))
        ]
        return [(token.start, token.end) for token in tokens if token.kind == "text"]

    def holders(self, agent: str) -> list[Agent]:
        """Returns the classes that have a class, a class that inherits from it, or one from which it inherits, as a part."""
        found = self.agents.get(agent)
        kinds = {one.name for one in self.agents.values() if found is not None and agent in (one.name, *self.above(one.name))}
        return [one for one in self.agents.values() if any(part.kind in kinds for part in one.parts.values())]

    def above(self, agent: str) -> list[str]:
        """Returns the classes of the text from which a class inherits."""
        found = [agent]
        for one in found:
            found += [base for base in self.agents[one].bases if base in self.agents and base not in found]
        return found[1:]

    # -- questions

    def text_at(self, at: int) -> ChunkText | None:
        """Returns the text of a chunk or pattern around a position."""
        return next((one for one in self.texts if one.start <= at <= one.end), None)

    def name_at(self, at: int) -> Name | None:
        """Returns the name around a position."""
        return next((one for one in self.names if one.start <= at <= one.end), None)

    def method(self, path: str) -> Method | None:
        """Returns a method by its agent and name."""
        agent, _, name = path.rpartition(".")
        return self.agents[agent].methods.get(name) if agent in self.agents else None

    def lineage(self, agent: str) -> list[Agent]:
        """Returns a class and the classes whose parts it can access, nearest first: those that it inherits from, and the agents that it
        is a part of."""
        found: list[Agent] = []
        waiting = [agent]
        while waiting:
            one = self.agents.get(waiting.pop(0))
            if one is not None and one not in found:
                found.append(one)
                waiting += [*one.bases, *(other.name for other in self.agents.values() if self._holds(other, one))]
        return found

    def _holds(self, agent: Agent, other: Agent) -> bool:
        """Returns whether a class has another, or a class that inherits from it, as a part."""
        kinds = {part.kind for part in agent.parts.values()}
        return other.name in kinds or any(other.name in self.agents[kind].bases for kind in kinds if kind in self.agents)

    def parts_of(self, agent: str) -> dict[str, Part]:
        """Returns the parts that a class sees by name."""
        return {name: part for one in reversed(self.lineage(agent)) for name, part in one.parts.items()}

    def may_be(self, agent: str, name: str) -> list[Part | None]:
        """Returns the parts that a name may mean in a class: other classes may replace a part; None stands for one that is not shown."""
        found: list[Part | None] = []
        asked: set[str] = set()
        waiting = [agent]
        for one in waiting:
            if one in asked:
                continue
            asked.add(one)
            above = self.above(one)
            nearest = next((self.agents[base].parts[name] for base in (one, *above) if name in self.agents[base].parts), None)
            below = [other for other in self.agents if one in self.above(other)]
            beside = {base for other in below for base in (other, *self.above(other)) if base not in (one, *above)}
            found += [self.agents[other].parts[name] for other in sorted(beside) if name in self.agents[other].parts]
            holders = [other.name for kind in (one, *below) for other in self.holders(kind)] if nearest is None else []
            found += [nearest] if nearest is not None or not holders else []
            waiting += holders
        return found

    def variables_of(self, method: str) -> list[Piece]:
        """Returns the variables in the patterns and requests of a method."""
        return [piece for one in self.texts if one.method == method for piece in one.pieces if piece.is_variable]

    def chunks_of(self, part: str, agent: str) -> list[ChunkText]:
        """Returns the texts about a part and about the modules that fill it, such as the memory of a retrieval buffer."""
        fills = {name for name, one in self.parts_of(agent).items() if part in one.given}
        return [one for one in self.texts if one.part == part or (one.part in fills and one.kind != "pattern")]

    def _describes(self, one: ChunkText) -> bool:
        """Returns whether a text describes a chunk: a default only in a production, an argument only of a part."""
        method = self.method(one.method)
        if one.kind == "pattern":
            return method is not None and method.sees_parts
        return one.part in self.parts_of(one.agent) or ":" in one.text or (method is not None and one.part in method.parameters)

    # -- reading

    def _take(self, number: int, token: CodeToken) -> None:
        if token.begins_statement:
            self._brackets.clear()
        if token.first and not self._brackets:
            self._begin_line(number, token)
        if token.kind == "name":
            self._take_name(number, token)
        elif token.kind == "text":
            self._take_text(token)
        elif token.kind == "end":
            self._statement = number + 1
        elif token.kind == "sign":
            self._take_sign(number, token)

    def _begin_line(self, number: int, token: CodeToken) -> None:
        self._statement = number
        if token.kind == "end":
            return
        while self._blocks and self._blocks[-1].column >= token.column:
            self._blocks.pop()
        method, self._headed = self._headed, None
        if method is not None and token.column > method.column and method.body is None:
            start = self.text.rfind("\n", 0, token.start) + 1
            method.body = token.line, self.text[start : start + token.column]

    def _before(self, number: int) -> tuple[str, ...]:
        """Returns the names that are joined by dots to the token of this number."""
        found: list[str] = []
        while number >= 2 and self._tokens[number - 1].text == "." and self._tokens[number - 2].kind == "name":
            number -= 2
            found.insert(0, self._tokens[number].text)
        if number >= 1 and self._tokens[number - 1].text == ".":
            found.insert(0, "")  # of any other expression
        return tuple(found)

    def _text(self, number: int) -> str:
        return self._tokens[number].text if 0 <= number < len(self._tokens) else ""

    def _take_name(self, number: int, token: CodeToken) -> None:
        bracket = self._brackets[-1] if self._brackets else None
        begins = bracket is not None and self._text(number - 1) in ("(", ",", "*", "**")
        keyword = begins and bracket is not None and bracket.kind in ("def", "call") and self._text(number + 1) == "="
        if number == self._statement + 1 and self._text(number - 1) in ("def", "class"):
            self._define(self._tokens[number - 1], token)
        elif bracket is not None and bracket.kind == "def" and begins:
            method = self.method(f"{self._agent}.{bracket.names[0]}")
            if method is not None:
                method.parameters[token.text] = keyword or self._text(number - 1)[:1] == "*"
        elif (
            bracket is not None
            and bracket.kind == "class"
            and self._text(number + 1) != "="
            and self._blocks
            and self._agent in self.agents
        ):
            bases, before = self.agents[self._agent].bases, self._before(number)
            if before:
                bases.pop()  # what stands before the dot
            bases.append(".".join((*before, token.text)))
        elif bracket is not None and bracket.part is not None and not keyword:
            bracket.part.given.append(token.text)
        if bracket is not None and begins:
            bracket.keyword = token.text if keyword else ""
        called = bracket.names if bracket is not None and bracket.kind == "call" else ()
        before = self._before(number)
        self.names.append(
            Name(text=token.text, start=token.start, before=before, keyword=keyword, called=called, agent=self._agent, method=self._method)
        )

    def _define(self, keyword: CodeToken, name: CodeToken) -> None:
        around, directly = self._agent, bool(self._blocks) and self._blocks[-1].kind == "class"
        self._blocks.append(_Block(kind=keyword.text, name=name.text, column=keyword.column))
        if keyword.text == "class":
            self.agents[self._agent] = Agent(name=self._agent, start=name.start)
        elif directly:
            self.agents[around].methods[name.text] = Method(name=name.text, agent=around, start=name.start, column=keyword.column)

    def _take_sign(self, number: int, token: CodeToken) -> None:
        if token.text in ("(", "[", "{"):
            self._open(number, token)
        elif token.text in (")", "]", "}"):
            if self._brackets:
                self._brackets.pop()
        elif token.text == "," and self._brackets:
            self._brackets[-1].place += 1
            self._brackets[-1].keyword = ""
        elif token.text == ":" and not self._brackets and self._blocks and self._text(self._statement) == "def":
            self._headed = self.method(f"{self._agent}.{self._blocks[-1].name}")

    def _open(self, number: int, token: CodeToken) -> None:
        before = self._tokens[number - 1] if token.text == "(" and number > 0 else None
        called = before is not None and (before.kind == "name" or before.text in (")", "]"))
        names = (*self._before(number - 1), before.text if before.kind == "name" else "") if before is not None and called else ()
        head = self._text(self._statement) if called and number == self._statement + 2 else ""
        kind = head if head in ("def", "class") else "call" if called else ""
        self._brackets.append(_Bracket(kind=kind, names=names, part=self._new_part(number, names) if kind == "call" else None))

    def _new_part(self, number: int, names: tuple[str, ...]) -> Part | None:
        """Returns the part that a statement of a class makes: `goal = Buffer(`."""
        first = self._statement
        if not self._blocks or self._blocks[-1].kind != "class" or self._text(first + 1) != "=" or number != first + 1 + 2 * len(names):
            return None
        name = self._tokens[first]
        part = Part(name=name.text, kind=names[-1], agent=self._agent, given=[], start=name.start)
        self.agents[self._agent].parts[name.text] = part
        return part

    def _take_text(self, token: CodeToken) -> None:
        """Stores a text that may describe a chunk or a pattern."""
        for bracket in reversed(self._brackets):
            if bracket.kind == "def":
                if bracket.keyword:
                    self._add_text("pattern", bracket.keyword, token)
                return
            if bracket.kind == "call":
                names = bracket.names
                reads = names[-1] in READERS
                if len(names) > 1 and (reads if bracket.keyword else bracket.place == 0 and (reads or names[-1] in GIVERS)):
                    self._add_text("request" if reads else "chunk", names[-2], token, bracket.keyword)
                return

    def _add_text(self, kind: str, part: str, token: CodeToken, slot: str = "") -> None:
        own, text = self._method, token.text
        self.texts.append(ChunkText(kind=kind, part=part, agent=self._agent, method=own, text=text, start=token.start, slot=slot))

    @property
    def _agent(self) -> str:
        """The class around the present position, after those around it."""
        return ".".join(block.name for block in self._blocks if block.kind == "class")

    @property
    def _method(self) -> str:
        functions = [block.name for block in self._blocks if block.kind == "def"]
        return f"{self._agent}.{functions[0]}" if functions and self._agent else ""
