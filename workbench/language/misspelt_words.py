"""Finds misspelt words of the library in the text of a model: features and their slots in patterns and in requests to vision, and commands
to bodies and their senses. The text is not executed.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Collection, Iterator, Mapping

from actr3d.actr.chunks.pattern import parse
from actr3d.actr.kernel.source_code import last_name, syntax_tree
from actr3d.actr.lint.found_kinds import KIND, Kinds, wrong_kind, wrong_names
from actr3d.actr.lint.slot_names import READERS, SURE, Vocabulary, is_production, slots_in
from actr3d.errors import PatternException, did_you_mean
from workbench.language.model_text import ModelText, Part

_KIND = re.compile(r"(?:^|\s)feature:(\w+)(?=\s|$)")

MAX_CLASSES = 100
"""Texts with more classes are not checked: the time to find the parts that each class sees grows faster than their number."""


def misspelt_words(text: str) -> Iterator[tuple[int, str]]:
    """Yields the line of each misspelt word and a message: for patterns, the same as the agent gives when it begins."""
    tree = syntax_tree(text)
    kinds = _kinds(tree) if _has_vision(tree) else {}
    defined = {node.name for node in ast.walk(tree) if isinstance(node, (ast.FunctionDef, ast.ClassDef))}
    has_body = "BodyPort" in text and "BodyPort" not in defined
    if not (kinds or has_body) or sum(isinstance(node, ast.ClassDef) for node in ast.walk(tree)) > MAX_CLASSES:
        return
    model, own = ModelText(text), Vocabulary(tree).written
    given = {*own, *(node.arg for node in ast.walk(tree) if isinstance(node, ast.arg))}
    for agent, method in _methods(tree.body):
        parts = model.parts_of(agent)
        if kinds and is_production(method):
            for line, wrong in _in_patterns(method, parts, kinds, own):
                yield line, f"production '{method.name}': {wrong}"
        for call, part in _calls(method, parts):
            word = call.args[0].value if call.args and isinstance(call.args[0], ast.Constant) else None
            if not isinstance(word, str) or not isinstance(call.func, ast.Attribute):
                continue
            line = call.args[0].lineno
            if part.kind == "Vision" and kinds and call.func.attr in READERS:
                yield from ((line, wrong) for kind in _KIND.findall(word) if (wrong := wrong_kind(kind, kinds, own)))
                yield from _in_request(call, word, kinds, given)
            elif part.kind == "BodyPort" and has_body and call.func.attr in ("set", "get", "request"):
                known = _words_of_bodies(call.func.attr)
                if hint := _hint(word, known, defined):
                    yield line, f"no body has a {'command' if call.func.attr == 'set' else 'sense'} '{word}'{hint}"


def _in_request(call: ast.Call, text: str, kinds: Kinds, given: Collection[str]) -> Iterator[tuple[int, str]]:
    """Yields the line and what is wrong in the slots and parameters of a request for a feature; `given` are the text's own names."""
    kind = next((kind for kind in _KIND.findall(text) if kind in kinds), None)
    if kind is None:
        return
    known = {KIND, "bottom_up", *kinds[kind], *_conditions(kind)}
    names = [(call.args[0].lineno, slot) for slot in slots_in(text)]
    names += [(keyword.lineno, keyword.arg) for keyword in call.keywords if keyword.arg]
    for line, name in names:
        if hint := _hint(name, known, given):
            yield line, f"no request for the feature '{kind}' takes '{name}'{hint}"


def _hint(word: str, known: Collection[str], own: Collection[str]) -> str:
    """Returns which known word is surely meant by another one; an empty text if none is, or the word is known or the text's own."""
    return "" if word in known or word in own else did_you_mean(word, known, SURE)


def _in_patterns(method: ast.FunctionDef, parts: Mapping[str, Part], kinds: Kinds, own: Collection[str]) -> Iterator[tuple[int, str]]:
    """Yields the line and what is wrong in the patterns of a production for buffers that only vision fills."""
    for parameter, default in zip(method.args.args, method.args.defaults, strict=False):
        if {part.kind for part in parts.values() if parameter.arg in part.given} != {"Vision"}:
            continue
        texts = default.elts if isinstance(default, (ast.List, ast.Tuple)) else [default]
        try:
            tests = [test for one in texts if isinstance(one, ast.Constant) and isinstance(one.value, str) for test in parse(one.value)]
        except PatternException:
            continue
        yield from ((default.lineno, wrong) for wrong in wrong_names(tests, kinds, own).values())


def _methods(body: list[ast.stmt], path: str = "") -> Iterator[tuple[str, ast.FunctionDef]]:
    """Yields the methods of classes, each with the path of its class."""
    for kind in (node for node in body if isinstance(node, ast.ClassDef)):
        yield from ((f"{path}{kind.name}", node) for node in kind.body if isinstance(node, ast.FunctionDef))
        yield from _methods(kind.body, f"{path}{kind.name}.")


def _calls(method: ast.FunctionDef, parts: Mapping[str, Part]) -> Iterator[tuple[ast.Call, Part]]:
    """Yields the calls of methods of parts: `vision.request`, `self.vision.request`, `self.parent.vision.request`."""
    for call in ast.walk(method):
        if isinstance(call, ast.Call) and isinstance(call.func, ast.Attribute):
            owner = call.func.value
            if isinstance(owner, ast.Name) or (isinstance(owner, ast.Attribute) and ast.unparse(owner.value) in ("self", "self.parent")):
                part = parts.get(last_name(owner))
                if part is not None:
                    yield call, part


def _has_vision(tree: ast.Module) -> bool:
    """Returns whether `Vision` is that of embodied agents."""
    return any(
        isinstance(node, ast.ImportFrom) and node.module == "actr3d.vision" and any(one.name in ("Vision", "*") for one in node.names)
        for node in tree.body
    )


def _kinds(tree: ast.Module) -> dict[str, set[str]]:
    """Returns the features of the library and those that the text defines, with their slots."""
    from actr3d.vision import DETECTORS, Feature  # only texts with vision need it
    from actr3d.vision.feature import slot_names

    library = [one for one in DETECTORS.values() if one.builtin]
    kinds = {one.name: {*slot_names(one.finds)} for one in library}
    classes = {kind.__name__: {*slot_names(kind)} for kind in (Feature, *(one.finds for one in library))}
    for node in (node for node in ast.walk(tree) if isinstance(node, ast.ClassDef)):
        above = [classes[name] for base in node.bases if (name := last_name(base)) in classes]
        if above:
            own = {one.target.id for one in node.body if isinstance(one, ast.AnnAssign) and isinstance(one.target, ast.Name)}
            kinds[node.name.lower()] = classes[node.name] = own.union(*above)
    return kinds


def _words_of_bodies(method: str) -> tuple[str, ...]:
    from workbench.language.library_words import words_for  # only texts with bodies need it

    return tuple(word.word for word in words_for("BodyPort", method))


def _conditions(kind: str) -> tuple[str, ...]:
    from workbench.language.library_words import features  # only texts with vision need it

    return tuple(name for word in features() if word.word == kind for name in word.conditions)
