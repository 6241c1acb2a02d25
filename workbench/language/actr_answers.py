"""Answers questions about the ACT-R in a model's text: slots, values, variables, parts and productions."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import replace

from workbench.language.answers import Completion, Hover, Item, Signature
from workbench.language.library_words import Word, answers_of, features_of, only_reads, scene_parts, words_for
from workbench.language.model_text import ChunkText, Method, ModelText, Name, Part, Piece
from workbench.language.python_answers import PythonExpressions

OWN, KNOWN, OTHER = 3, 2, 0
"""The ranks of completions: used with the same part, given by the library, used with other parts."""
_SLOT = re.compile(r"(\??[\w.]+):(.*)", re.DOTALL)
_SIGN = re.compile(r"(!?\??)[<>=]*([\w.-]*)$")
_WORD_AND_VALUES = re.compile(r"""\(\s*["'](\w+)["']\s*,(.*)""", re.DOTALL)
_PARTS = re.compile(r"\bparts\s*=\s*$")
_CONSTANT = re.compile(r"""\s*=\s*(?:(["'])([^\s"']*)\1|([+-]?[\d.]+|True|False|None))\s*[,)]""")
MAX_NAMED = 8
"""How many names are listed in a documentation."""


# -- completion


def complete(model: ModelText, at: int, attributes: PythonExpressions) -> Completion | None:
    """Returns what may come at a position of a text of chunks or patterns; None if that is not the place."""
    text = model.text_at(at)
    if text is None:
        return None
    word = re.search(r"\S*$", text.text[: at - text.start])
    assert word is not None
    slot = None if text.slot else _SLOT.match(word[0])
    value = slot[2] if slot else word[0]
    sign = _SIGN.search(value)
    assert sign is not None
    start = at - len(sign[2]) - ("?" in sign[1])
    words = [] if text.slot else _words_of_part(model, text)
    if words:
        used = {
            piece.text for one in _elsewhere(model.chunks_of(text.part, text.agent), at) if one.kind == text.kind for piece in one.pieces
        }
        own = [Item(label=word, type="function", boost=OWN) for word in used]
        return Completion(start=start, items=distinct([*words, *own]) if word.start() == 0 else [])
    variables = _variables(model, text, at)
    if "?" in sign[1]:
        return Completion(start=start, items=variables)
    place = len(text.text[: word.start()].split())
    values = [*_values(model, text, slot[1] if slot else text.slot or str(place), at, attributes), *variables]
    if slot or text.slot or sign[1]:
        return Completion(start=start, items=distinct(values))
    named = any(":" in one for one in text.text[: word.start()].split())
    slots = _slots(model, text, at, attributes)
    return Completion(start=start, items=distinct([*([] if named else _words(model, text, place)), *slots, *([] if named else values)]))


def complete_name(model: ModelText, at: int, attributes: PythonExpressions) -> tuple[list[Item], bool]:
    """Returns the slots, parts or parameters whose names may come at a position in code, and whether nothing else may.

    Args:
        model: The text, with a name at the position.
        at: The position.
        attributes: Returns the attributes of an expression.
    """
    name = model.name_at(at)
    if name is None or name.before:
        return [], False
    if name.agent in model.agents and not name.method and not model.text[: name.start].rpartition("\n")[2].strip():
        return [
            Item(label=label, type="property", detail=f"of {name.agent}", boost=KNOWN, text=said, apply=f"{label} = ")
            for label, said in attributes.attributes(name.agent)
            if label not in model.parts_of(name.agent)
        ], False
    if model.text[: name.start].rstrip()[-1:] not in ("(", ","):
        return [], False
    method = model.method(name.method)
    if method is not None and not name.called and name.text in method.parameters and (method.sees_parts or not name.keyword):
        if len(method.parameters) > 1 and "self" in method.parameters:
            return [], False
        taken = method.parameters.keys()
        parts = [part for part in model.parts_of(name.agent).values() if part.name not in taken]
        return [Item(label=part.name, type="variable", detail=part.kind, apply=f'{part.name}="${{}}"', boost=OWN) for part in parts], True
    if name.called[-1:] == ("modify",) and len(name.called) > 1:
        about = ChunkText(kind="chunk", part=name.called[-2], agent=name.agent, method=name.method, text="", start=at)
        begin = max(one.start for one in model.names if one.text == "modify" and one.start < name.start)
        given = {one.text for one in model.names if one.keyword and one.called == name.called and begin < one.start < name.start}
        slots = distinct(item for item in _slots(model, about, at, attributes) if item.label.isidentifier() and item.label not in given)
        return [Item(label=f"{item.label}=", type=item.type, detail=item.detail, boost=item.boost, text=item.text) for item in slots], False
    conditions = _conditions(model, name, attributes)
    return [
        Item(label=f"{label}=", type="property", detail=f"of {word.word}", boost=KNOWN, text=said)
        for word, slots in conditions
        for label, said in slots.items()
    ], False


def _conditions(model: ModelText, name: Name, attributes: PythonExpressions | None = None) -> list[tuple[Word, dict[str, str]]]:
    """Returns the features that the request around a name may search for, with the keyword arguments of each, such as `width=">0.5"`."""
    part = model.parts_of(name.agent).get(name.called[-2]) if name.called[-1:] == ("request",) and len(name.called) > 1 else None
    if part is None:
        return []
    before = [
        one for one in model.texts if (one.kind, one.part, one.method) == ("request", part.name, name.method) and one.end < name.start
    ]
    named = {piece.text for piece in before[-1].pieces} if before else set[str]()
    words = list(_features(model, part, attributes))
    words = [word for word in words if word.word in named] or words
    return [(word, {slot: said for slot, said in (word.slots | word.conditions).items() if slot != "feature"}) for word in words]


def complete_part(text: str, start: int) -> list[Item]:
    """Returns the parts of a scene that may come at a position in code: in the brackets of `parts=(`."""
    if not _PARTS.search(text[: _bracket_around(text, start)]):
        return []
    found: list[Item] = []
    for part in scene_parts():
        known = re.search(rf"^from actr3d\.world import (\*|(\([^)]*|[^\n]*)\b{part.word}\b)", text, re.MULTILINE)
        needs = "" if known else f"from actr3d.world import {part.word}"
        inserted = f"{part.word}(${{}})"
        found.append(Item(label=part.word, type="class", detail="part", boost=OWN, text=part.text, apply=inserted, needs=needs))
    return found


def sign(model: ModelText, at: int) -> Signature | None:
    """Returns the signature of the command or question to a body whose brackets contain a position: `body.set("heading", `."""
    bracket = _bracket_around(model.text, at)
    name = model.name_at(bracket)
    part = model.parts_of(name.agent).get(name.before[-1]) if name is not None and name.before and bracket else None
    found = _WORD_AND_VALUES.match(model.text[bracket:at])
    if name is None or part is None or found is None:
        return None
    for word in words_for(part.kind, "set" if name.text == "set" else "request"):
        if word.word == found[1]:
            parameters = word.takes.split(", ") if word.takes else []
            *before, now = found[2].split(",")
            named = re.match(r"\s*(\w+)\s*=", now)
            names = [one.partition("=")[0] for one in parameters]
            active = names.index(named[1]) if named and named[1] in names else len(before)
            return Signature(name=word.word, parameters=parameters, active=active if active < len(parameters) else None, text=word.text)
    return None


def _bracket_around(text: str, at: int) -> int:
    """Returns where the innermost bracket opens that is open at a position; 0 for none."""
    closed = 0
    for place in range(at - 1, -1, -1):
        closed += (text[place] in ")]}") - (text[place] in "([{")
        if closed < 0:
            return place
    return 0


def distinct(items: Iterable[Item]) -> list[Item]:
    """Returns items without a second one of the same label; the one of the highest rank counts."""
    best: dict[str, Item] = {}
    for item in items:
        if item.label not in best or best[item.label].boost < item.boost:
            best[item.label] = item
    return list(best.values())


def _elsewhere(texts: Iterable[ChunkText], at: int) -> Iterator[ChunkText]:
    """Yields texts without the one that is being written: a half-written name is no name yet."""
    return (one for one in texts if not one.start <= at <= one.end)


def _slots(model: ModelText, text: ChunkText, at: int, attributes: PythonExpressions) -> Iterator[Item]:
    """Yields the slots that a text may name and does not name yet."""
    used = {slot.text for slot in text.slots if not slot.start <= at <= slot.end}
    own = model.chunks_of(text.part, text.agent)
    parts = model.parts_of(text.agent)
    part = parts.get(text.part)
    if part is not None and text.kind == "request" and features_of(part.kind) and "feature" not in used:
        yield Item(label="feature", type="property", detail="what to find", boost=KNOWN, apply="feature:")
        return
    for word in _answers(model, text, attributes):
        yield from (
            Item(label=name, type="property", detail=f"slot of {word.word}", boost=KNOWN, text=said, apply=f"{name}:")
            for name, said in word.slots.items()
            if name not in used
        )
    if part is not None and part.kind != "Buffer" and text.kind == "pattern":
        for name, said in attributes.attributes(f"{part.agent}.{part.name}"):
            yield Item(label=name, type="property", detail=f"of {part.name}, {part.kind}", boost=KNOWN, text=said, apply=f"{name}:")
    for rank, texts in ((OWN, own), (OTHER, model.texts)):
        for one in _elsewhere(texts, at):
            for slot in one.slots:
                if slot.text not in used:
                    yield Item(label=slot.text, type="property", detail=f"slot, {one.part}", boost=rank, apply=f"{slot.text}:")


def _answers(model: ModelText, text: ChunkText, attributes: PythonExpressions | None = None) -> list[Word]:
    """Returns what the library puts into a buffer, or what a module searches for; if the text names one, only that."""
    found: list[Word] = []
    for part in model.parts_of(text.agent).values():
        if text.part in part.given and text.kind == "pattern":
            found += answers_of(part.kind)
        if text.part in part.given if text.kind == "pattern" else text.part == part.name:
            found += _features(model, part, attributes)
    named = {piece.text for piece in text.pieces}
    return [word for word in found if word.word in named] or found


def _features(model: ModelText, part: Part, attributes: PythonExpressions | None = None) -> Iterator[Word]:
    """Yields the features that a module finds: the library's, and those that the text itself defines."""
    library = features_of(part.kind)
    for one in library:
        yield replace(one, slots={"feature": "", **one.slots})
    for agent in model.agents.values() if library else ():
        if "Feature" in agent.bases:
            slots = dict(attributes.parameters(agent.name)) if attributes is not None else {}
            yield Word(word=agent.name.lower(), text=f"{agent.name}, in this file", slots={"feature": "", **slots})


def _words(model: ModelText, text: ChunkText, place: int) -> list[Item]:
    """Returns the words of the library that may begin a text."""
    parts = model.parts_of(text.agent).values() if place == 0 and text.kind == "pattern" else ()
    words = (word for one in parts if text.part in one.given for word in answers_of(one.kind))
    return [Item(label=word.word, type="function", detail="sensed", boost=OTHER, text=word.text) for word in words]


def _words_of_part(model: ModelText, text: ChunkText) -> list[Item]:
    """Returns the words that the library gives to a method of a part: the commands of a body, and what it senses; these are no chunks."""
    part = model.parts_of(text.agent).get(text.part)
    if part is None or text.kind == "pattern":
        return []
    words = words_for(part.kind, "set" if text.kind == "chunk" else "request")
    return [Item(label=one.word, type="function", detail=f"({one.takes})" if one.takes else "", boost=OWN, text=one.text) for one in words]


def _values(model: ModelText, text: ChunkText, slot: str, at: int, attributes: PythonExpressions) -> Iterator[Item]:
    """Yields the values that the text knows of a slot."""
    parts = model.parts_of(text.agent)
    part = parts.get(text.part)
    if slot == "feature":
        for one in parts.values():
            if text.part in one.given or one.name == text.part:
                for word in _features(model, one):
                    yield Item(label=word.word, type="constant", detail="feature", boost=OWN, text=word.text)
    tests_module = part is not None and part.kind != "Buffer" and text.kind == "pattern" and slot.isidentifier()
    if part is not None and tests_module and attributes.is_truth(f"{part.agent}.{part.name}.{slot}"):
        yield from (Item(label=word, type="constant", detail=f"{slot} of {part.name}", boost=KNOWN) for word in ("False", "True"))
    own = model.chunks_of(text.part, text.agent)
    for rank, texts in ((OWN, own), (OTHER, model.texts if not slot.isdecimal() else ())):
        for one in _elsewhere(texts, at):
            for piece in one.pieces:
                if piece.slot == slot and not piece.is_variable:
                    detail = f"{slot}, {one.part}" if not slot.isdecimal() else one.part
                    yield Item(label=piece.text, type="constant", detail=detail, boost=rank)


def _variables(model: ModelText, text: ChunkText, at: int) -> list[Item]:
    """Returns the variables of the method."""
    names = dict.fromkeys(piece.text for piece in model.variables_of(text.method) if not piece.start <= at <= piece.end)
    return [Item(label=f"?{name}", type="variable", detail="variable", boost=OTHER) for name in names]


# -- documentation


def document(model: ModelText, at: int) -> Hover | None:
    """Returns what the text itself says of a slot, value, variable, part or production at a position."""
    text = model.text_at(at)
    if text is not None:
        return _document_in(model, text, at)
    name = model.name_at(at)
    if name is None:
        return None
    part = part_of(model, name)
    if part is not None:
        return Hover(
            start=name.start, end=name.end, title=f"{part.name} = {part.kind}({', '.join(part.given)})", text=_of_part(model, part)
        )
    method = model.method(name.method)
    if method is not None and method.start == name.start and method.sees_parts and method.parameters:
        return Hover(start=name.start, end=name.end, title=f"production {method.name}", text=_of_production(model, method))
    if is_variable(model, name):
        return Hover(start=name.start, end=name.end, title=f"?{name.text}", text=_of_variable(model, name.method, name.text))
    if is_modified(name):
        return Hover(start=name.start, end=name.end, title=f"slot {name.text}", text=_of_slot(model, name.text))
    said = [f"{word.word}: {slots[name.text]}" for word, slots in _conditions(model, name) if name.keyword and slots.get(name.text)]
    if said:
        return Hover(start=name.start, end=name.end, title=f"condition {name.text}", text="\n".join(said))
    return None


def _document_in(model: ModelText, text: ChunkText, at: int) -> Hover | None:
    for slot in text.slots:
        if slot.start <= at <= slot.end:
            return Hover(start=slot.start, end=slot.end, title=f"slot {slot.text}", text=_of_slot(model, slot.text, text))
    for piece in text.pieces:
        if piece.start - len(piece.sign) <= at <= piece.end:
            start = piece.start - len(piece.sign)
            if piece.is_variable:
                return Hover(start=start, end=piece.end, title=f"?{piece.text}", text=_of_variable(model, text.method, piece.text))
            return Hover(start=start, end=piece.end, title=f"value {piece.text}", text=_of_value(model, text, piece))
    return None


def _of_slot(model: ModelText, slot: str, text: ChunkText | None = None) -> str:
    lines: list[str] = []
    if text is not None:
        lines += [f"{word.word}: {word.slots[slot]}" for word in _answers(model, text) if word.slots.get(slot)]
    uses = [one for one in model.texts if any(other.text == slot for other in one.slots)]
    modified = _modified(model, slot)
    places = {kind: [(one.start, one.method) for one in uses if one.kind == kind] for kind in ("pattern", "chunk", "request")}
    places["chunk"] += [(name.start, name.method) for name in modified]
    for what, kind in (("matched in", "pattern"), ("set in", "chunk"), ("requested in", "request")):
        lines.append(_listed(what, (method.rpartition(".")[2] for _, method in sorted(places[kind]))))
    values = [(piece.start, piece.text) for one in uses for piece in one.pieces if piece.slot == slot and not piece.is_variable]
    values += [(name.start, value) for name, value in modified.items() if value]
    lines.append(_listed("values:", (value for _, value in sorted(values))))
    return "\n".join(line for line in lines if line)


def _modified(model: ModelText, slot: str) -> dict[Name, str]:
    """Returns the names of a slot in calls such as `goal.modify(task="say")`, each with its value; an empty text for a computed one."""
    named = [one for one in model.names if one.text == slot and is_modified(one)]
    values = {name: _CONSTANT.match(model.text, name.end) for name in named}
    return {name: found[2] or found[3] or "" if found else "" for name, found in values.items()}


def is_modified(name: Name) -> bool:
    """Returns whether a name is that of a slot in a call such as `goal.modify(task="say")`."""
    return name.keyword and name.called[-1:] == ("modify",)


def giver(model: ModelText, text: ChunkText, slot: str) -> str:
    """Returns what of the library gives a slot of a text its name; empty if nothing does."""
    return next((word.word for word in _answers(model, text) if slot in word.slots), "")


def _of_value(model: ModelText, text: ChunkText, piece: Piece) -> str:
    part = model.parts_of(text.agent).get(text.part)
    known = words_for(part.kind, "set" if text.kind == "chunk" else "request") if part is not None and text.kind != "pattern" else ()
    lines = [f"{one.word}({one.takes}): {one.text}" for one in known if one.word == piece.text]
    lines += [f"{word.word}: {word.text}" for word in _answers(model, text) if word.word == piece.text]
    where = f"in slot {piece.slot}" if not piece.slot.isdecimal() else f"word {int(piece.slot) + 1}"
    uses = [
        (one.start, one.method) for one in model.texts if any(other.text == piece.text and other.slot == piece.slot for other in one.pieces)
    ]
    uses += [(name.start, name.method) for name, value in _modified(model, piece.slot).items() if value == piece.text]
    lines.append(f"{where}, {_listed('used in', (method.rpartition('.')[2] for _, method in sorted(uses)))}")
    return "\n".join(lines)


def _of_variable(model: ModelText, method: str, name: str) -> str:
    bound = [one for one in model.texts if one.method == method and any(p.text == name and p.is_variable for p in one.pieces)]
    slots = (
        f"{one.part}'s {f'slot {p.slot}' if not p.slot.isdecimal() else f'word {int(p.slot) + 1}'}"
        for one in bound
        for p in one.pieces
        if p.text == name and p.is_variable
    )
    return f"A variable of {method.rpartition('.')[2]}: the same value in all places.\n{_listed('in', slots)}"


def _of_part(model: ModelText, part: Part) -> str:
    own = model.chunks_of(part.name, part.agent)
    matched = (one.method.rpartition(".")[2] for one in model.texts if one.part == part.name and one.kind == "pattern")
    fills = (name for name, one in model.parts_of(part.agent).items() if part.name in one.given and not only_reads(_kinds(model, one)))
    slots = (slot.text for one in own for slot in one.slots)
    words = (piece.text for one in own for piece in one.pieces if piece.slot == "0" and not piece.is_variable)
    lines = [_listed("filled by", fills), _listed("first words:", words), _listed("slots:", slots), _listed("matched in", matched)]
    return "\n".join(line for line in lines if line)


def _kinds(model: ModelText, part: Part) -> list[str]:
    """Returns the class of a part, and, if the text defines it, those that it inherits from."""
    kinds = [part.kind]
    for kind in kinds:
        kinds += [base for base in model.agents[kind].bases if base not in kinds] if kind in model.agents else []
    return kinds


def _of_production(model: ModelText, method: Method) -> str:
    patterns = [one for one in model.texts if one.method == method.path and one.kind == "pattern"]
    return "\n".join(f"{one.part}: {one.text}" for one in patterns)


def _listed(what: str, names: Iterable[str]) -> str:
    """Returns names without repetitions as a line of text; an empty text without names."""
    distinct = list(dict.fromkeys(name for name in names if name))
    more = f" and {len(distinct) - MAX_NAMED} more" if len(distinct) > MAX_NAMED else ""
    return f"{what} {', '.join(distinct[:MAX_NAMED])}{more}" if distinct else ""


# -- definition


def part_of(model: ModelText, name: Name) -> Part | None:
    """Returns the part of an agent that a name in its code means."""
    parts = model.parts_of(name.agent)
    if name.text not in parts:
        return None
    part = parts[name.text]
    if name.start == part.start or name.before == ("self",):
        return part
    if name.before or (name.called and name.keyword):
        return None
    method = model.method(name.method)
    is_known = method is None or (method.sees_parts and not _is_variable_of(model, name.method, name.text))
    return part if is_known else None


def is_variable(model: ModelText, name: Name) -> bool:
    """Returns whether a name in the body of a method means a variable of its patterns."""
    return not name.before and not name.keyword and _is_variable_of(model, name.method, name.text)


def _is_variable_of(model: ModelText, method: str, name: str) -> bool:
    found = model.method(method)
    return found is not None and found.sees_parts and any(piece.text == name for piece in model.variables_of(method))


def define(model: ModelText, at: int) -> int | None:
    """Returns where a part, a variable or a slot is first written; None if there is none at the position."""
    text = model.text_at(at)
    if text is not None:
        slot = next((one.text for one in text.slots if one.start <= at <= one.end), None)
        if slot is not None:
            return _first_of_slot(model, slot)
        variables = (one for one in text.pieces if one.is_variable)
        variable = next((one.text for one in variables if one.start - len(one.sign) <= at <= one.end), None)
        return None if variable is None else _first_of_variable(model, text.method, variable)
    name = model.name_at(at)
    if name is None:
        return None
    if is_variable(model, name):
        return _first_of_variable(model, name.method, name.text)
    part = part_of(model, name)
    return part.start if part is not None else _first_of_slot(model, name.text) if is_modified(name) else None


def _first_of_slot(model: ModelText, slot: str) -> int:
    """Returns where a slot is first set by a text of a chunk, or else where it is first named; it is named somewhere."""
    named = [(one.start, text.kind) for text in model.texts for one in text.slots if one.text == slot]
    modified = [one.start for one in model.names if one.text == slot and is_modified(one)]
    read = [found.start(1) for found in re.finditer(rf"\w\[[\"']({re.escape(slot)})[\"']\]", model.text)]
    return next((start for start, kind in named if kind == "chunk"), min([*(start for start, _ in named), *modified, *read]))


def _first_of_variable(model: ModelText, method: str, variable: str) -> int:
    """Returns where a variable of a method is first written; it is written somewhere."""
    inside = [piece.start for piece in model.variables_of(method) if piece.text == variable]
    used = [one.start for one in model.names if one.method == method and one.text == variable and is_variable(model, one)]
    return min(inside + used)
